#include "firmware_bridge/camera/libcamera_buffers.hpp"

#include <algorithm>
#include <cerrno>
#include <system_error>

#include <libcamera/formats.h>
#include <linux/dma-buf.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <unistd.h>

#include "firmware_bridge/camera/libcamera_format.hpp"
#include "firmware_bridge/device_error.hpp"
#include "firmware_bridge/wire/unique_fd.hpp"

namespace biotomy::bridge {

namespace {

/// Brackets the processor's reads of a buffer that a device wrote, so that caches agree.
class ReadAccess {
 public:
  explicit ReadAccess(int descriptor) : descriptor_(descriptor) { sync(DMA_BUF_SYNC_START); }
  ~ReadAccess() { sync(DMA_BUF_SYNC_END); }
  ReadAccess(const ReadAccess&) = delete;
  ReadAccess& operator=(const ReadAccess&) = delete;

 private:
  void sync(std::uint64_t edge) const {
    dma_buf_sync request{};
    request.flags = edge | DMA_BUF_SYNC_READ;
    // It fails on memory that is no dma-buf, where there is nothing to bring into agreement.
    while (::ioctl(descriptor_, DMA_BUF_IOCTL_SYNC, &request) != 0 && errno == EINTR) {
    }
  }

  int descriptor_;
};

struct PlaneExtent {
  unsigned int offset;
  unsigned int length;
};

/// How a frame's planes lie one after the other. Of the formats we read only NV12 has two.
std::vector<PlaneExtent> planes_of(const libcamera::StreamConfiguration& configuration) {
  if (configuration.pixelFormat != libcamera::formats::NV12) {
    return {{0, configuration.frameSize}};
  }
  const unsigned int luma = configuration.stride * configuration.size.height;
  return {{0, luma}, {luma, configuration.frameSize - luma}};
}

[[noreturn]] void refuse(const std::string& what) {
  throw DeviceError(DeviceError::Kind::configuration, "camera: " + what);
}

}  // namespace

LibcameraBuffers::LibcameraBuffers(std::shared_ptr<libcamera::Camera> camera,
                                   libcamera::Stream* stream)
    : stream_(stream),
      allocator_(std::make_unique<libcamera::FrameBufferAllocator>(std::move(camera))) {
  if (allocator_->allocate(stream) < 0) make_own(stream->configuration());
  try {
    for (const auto& buffer : all()) map(*buffer);
  } catch (...) {
    unmap_all();
    throw;
  }
}

LibcameraBuffers::~LibcameraBuffers() {
  unmap_all();
}

const std::vector<std::unique_ptr<libcamera::FrameBuffer>>& LibcameraBuffers::all() const {
  return own_.empty() ? allocator_->buffers(stream_) : own_;
}

void LibcameraBuffers::make_own(const libcamera::StreamConfiguration& configuration) {
  for (unsigned int i = 0; i < configuration.bufferCount; ++i) {
    UniqueFd memory(::memfd_create("camera-frame", MFD_CLOEXEC));
    if (!memory.valid() || ::ftruncate(memory.get(), configuration.frameSize) != 0) {
      refuse("no memory for its frames: " + std::generic_category().message(errno));
    }
    const int descriptor = memory.get();
    const libcamera::SharedFD shared(descriptor);  // a duplicate: it takes over what is no variable
    std::vector<libcamera::FrameBuffer::Plane> planes;
    for (const auto& [offset, length] : planes_of(configuration)) {
      libcamera::FrameBuffer::Plane plane;
      plane.fd = shared;
      plane.offset = offset;
      plane.length = length;
      planes.push_back(plane);
    }
    own_.push_back(std::make_unique<libcamera::FrameBuffer>(planes));
  }
}

void LibcameraBuffers::map(const libcamera::FrameBuffer& buffer) {
  for (const auto& plane : buffer.planes()) {
    const int descriptor = plane.fd.get();
    const bool is_mapped = std::any_of(mappings_.begin(), mappings_.end(), [&](const Mapping& m) {
      return m.descriptor == descriptor;
    });
    if (is_mapped) continue;

    std::size_t size = 0;
    for (const auto& other : buffer.planes()) {
      if (other.fd.get() == descriptor) {
        size = std::max<std::size_t>(size, std::size_t{other.offset} + other.length);
      }
    }
    void* data = ::mmap(nullptr, size, PROT_READ, MAP_SHARED, descriptor, 0);
    if (data == MAP_FAILED) {
      refuse("its frames cannot be mapped: " + std::generic_category().message(errno));
    }
    mappings_.push_back({descriptor, data, size});
  }
}

void LibcameraBuffers::unmap_all() {
  for (const Mapping& mapping : mappings_) ::munmap(mapping.data, mapping.size);
  mappings_.clear();
}

const LibcameraBuffers::Mapping& LibcameraBuffers::mapping_of(int descriptor) const {
  const auto found = std::find_if(mappings_.begin(), mappings_.end(),
                                  [&](const Mapping& m) { return m.descriptor == descriptor; });
  if (found == mappings_.end()) throw PixelError("a frame in memory that is not the camera's");
  return *found;
}

cv::Mat LibcameraBuffers::to_image(const libcamera::FrameBuffer& buffer,
                                   const libcamera::StreamConfiguration& configuration,
                                   const RawColours& raw) const {
  const auto& planes = buffer.planes();
  const auto& filled = buffer.metadata().planes();

  std::vector<PixelPlane> parts;
  std::vector<std::unique_ptr<ReadAccess>> accesses;
  for (std::size_t i = 0; i < planes.size(); ++i) {
    const Mapping& mapping = mapping_of(planes[i].fd.get());
    accesses.push_back(std::make_unique<ReadAccess>(mapping.descriptor));
    // Some drivers leave the number of used bytes unset; then all of the plane is meant.
    std::size_t used = i < filled.size() ? filled[i].bytesused : 0;
    if (used == 0 || used > planes[i].length) used = planes[i].length;
    parts.push_back({{static_cast<const std::uint8_t*>(mapping.data) + planes[i].offset, used},
                     configuration.stride});
  }
  const auto width = static_cast<int>(configuration.size.width);
  const auto height = static_cast<int>(configuration.size.height);
  const FrameFormat format = *known_format(configuration.pixelFormat);
  if (const auto* bayer = std::get_if<BayerFormat>(&format)) {
    return demosaic(*bayer, width, height, parts.front(), raw);
  }
  return to_rgb(std::get<PixelFormat>(format), width, height, parts, coding_of(configuration));
}

}  // namespace biotomy::bridge
