#include "firmware_bridge/wire/shared_frame.hpp"

#include <cerrno>
#include <string>
#include <system_error>

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>

#include "firmware_bridge/wire/rig_socket.hpp"

namespace biotomy::bridge {

namespace {

[[noreturn]] void fail(const char* what) {
  throw std::system_error(errno, std::generic_category(), what);
}

}  // namespace

FrameMemory::FrameMemory(std::size_t size)
    : size_(size), descriptor_(::memfd_create("biotomy-frame", MFD_CLOEXEC | MFD_ALLOW_SEALING)) {
  if (!descriptor_.valid()) fail("shared frame: memfd_create");
  // The pages are had now or not at all: writing to a hole when memory is out would be a SIGBUS.
  if (::posix_fallocate(descriptor_.get(), 0, static_cast<off_t>(size)) != 0) {
    throw std::system_error(ENOMEM, std::generic_category(), "shared frame: no memory for a frame");
  }
  data_ = ::mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_SHARED, descriptor_.get(), 0);
  if (data_ == MAP_FAILED) {
    data_ = nullptr;
    fail("shared frame: mmap");
  }
}

FrameMemory::~FrameMemory() {
  unmap();
}

UniqueFd FrameMemory::seal() {
  unmap();  // a writable mapping would make F_SEAL_WRITE fail
  constexpr int kSeals = F_SEAL_WRITE | F_SEAL_SHRINK | F_SEAL_GROW | F_SEAL_SEAL;
  if (::fcntl(descriptor_.get(), F_ADD_SEALS, kSeals) != 0) fail("shared frame: sealing");
  return std::move(descriptor_);
}

void FrameMemory::unmap() {
  if (data_ != nullptr) ::munmap(data_, size_);
  data_ = nullptr;
  size_ = 0;
}

MappedFrame::MappedFrame(const UniqueFd& descriptor, std::size_t expected_size) {
  const auto refuse = [](const std::string& what) {
    throw RigSocketError(RigSocketError::Kind::malformed, "shared frame: " + what);
  };
  if (!descriptor.valid()) refuse("the frame came without its memory");
  // Seals first: once it can't shrink, its size is a fact.
  constexpr int kNeeded = F_SEAL_WRITE | F_SEAL_SHRINK;
  const int seals = ::fcntl(descriptor.get(), F_GET_SEALS);
  if (seals < 0 || (seals & kNeeded) != kNeeded) {
    refuse("its memory is not sealed against writing and shrinking");
  }
  struct stat status {};
  if (::fstat(descriptor.get(), &status) != 0) fail("shared frame: fstat");
  if (status.st_size < 0 || static_cast<std::size_t>(status.st_size) != expected_size) {
    refuse("its memory has " + std::to_string(status.st_size) + " bytes, the frame " +
           std::to_string(expected_size));
  }
  if (expected_size == 0) refuse("a frame of no bytes");
  // Private, since kernels before 6.7 refuse to share a mapping of what is sealed against writing.
  data_ = ::mmap(nullptr, expected_size, PROT_READ, MAP_PRIVATE, descriptor.get(), 0);
  if (data_ == MAP_FAILED) {
    data_ = nullptr;
    fail("shared frame: mmap");
  }
  size_ = expected_size;
}

MappedFrame::~MappedFrame() {
  if (data_ != nullptr) ::munmap(data_, size_);
}

}  // namespace biotomy::bridge
