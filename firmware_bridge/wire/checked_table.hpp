#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "firmware_bridge/wire/configuration_error.hpp"
#include "firmware_bridge/wire/configuration_key.hpp"

namespace biotomy::bridge {

/// A table of a TOML file, read key by key with every key accounted for. A wrong type, a value out
/// of range, a missing required key and, at the end, a key that nobody asked for are each a
/// ConfigurationError such as
///   rig.toml:12: camera.exposre_us: unknown key; did you mean "exposure_us"?
/// Reading code declares its keys by reading them, so the same code run over `for_reference()`
/// yields the list of all keys for the reference page.
/// A CheckedTable is a light handle: copies and sub-tables share one document. One thread uses it.
class CheckedTable {
 public:
  static CheckedTable read_file(const std::filesystem::path& file);

  /// `source` stands for the file's name in messages.
  static CheckedTable parse(std::string_view text, const std::string& source);

  /// An empty document in which required keys are answered with a placeholder (empty text, false,
  /// the least number allowed): for declared_keys() only, never to run with.
  static CheckedTable for_reference();

  /// A sub-table, empty if the file has none.
  CheckedTable table(const std::string& name) const;

  /// The sub-tables of a table whose keys are data (names of registers); all are accounted for. Any
  /// other key in it is an error.
  std::vector<std::pair<std::string, CheckedTable>> named_tables() const;

  /// Whether the file has this key or table. Asking doesn't account for it.
  bool has(const std::string& name) const;

  std::string get(const TextKey& key) const;
  bool get(const FlagKey& key) const;
  std::int64_t get(const IntegerKey& key) const;
  double get(const NumberKey& key) const;
  std::vector<double> get(const NumbersKey& key) const;
  std::vector<std::string> get(const TextsKey& key) const;

  /// A path as the file means it: relative ones are relative to the file's folder.
  std::filesystem::path resolve(const std::string& path) const;

  /// Throws the ConfigurationError for a key of this table: "file:line: table.key: what".
  [[noreturn]] void reject(const std::string& key, const std::string& what) const;

  /// To be called once all was read, on any table of the document: throws for the first key in the
  /// document that was never asked for.
  void refuse_unknown_keys() const;

  /// Every key asked for in the whole document, in the order of asking, each once.
  std::vector<DeclaredKey> declared_keys() const;

  /// The file's name, as messages give it.
  const std::string& source() const;

 private:
  struct Document;
  CheckedTable(std::shared_ptr<Document> document, std::string path);

  std::shared_ptr<Document> document_;
  std::string path_;  ///< of this table: "" at the top, "lines.lamp"
};

}  // namespace biotomy::bridge
