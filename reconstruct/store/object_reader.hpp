#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>

namespace biotomy::reconstruct {

/// One content of a named object. A name keeps its content until it is replaced as a whole; then
/// its version changes (what a web server calls an ETag).
struct ObjectVersion {
  std::uint64_t size = 0;
  std::string tag;

  friend bool operator==(const ObjectVersion&, const ObjectVersion&) = default;
};

/// The object was replaced since its version was asked for: what was concluded from it, an offset
/// for instance, no longer holds.
class ObjectReplaced : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// All that a volume knows of where it is stored: named objects and ranges of their bytes. Names
/// are relative, with '/'. Safe for many threads.
class ObjectReader {
 public:
  virtual ~ObjectReader() = default;

  /// Where `name` lies, for messages.
  virtual std::string describe(const std::string& name) const = 0;

  /// None when there is no such object. Throws SampleError when that cannot be found out.
  virtual std::optional<ObjectVersion> version(const std::string& name) = 0;

  /// Fills `out` from `offset` on. Throws ObjectReplaced when `name` has another version now, and
  /// SampleError when the object ends before or cannot be read.
  virtual void read(const std::string& name, const ObjectVersion& version, std::uint64_t offset,
                    std::span<std::byte> out) = 0;

  /// These bytes will be read soon: whoever can may begin to fetch them. Returns at once and never
  /// fails; what is wrong is told by the reading.
  virtual void expect(const std::string& name, const ObjectVersion& version, std::uint64_t offset,
                      std::uint64_t length) = 0;
};

}  // namespace biotomy::reconstruct
