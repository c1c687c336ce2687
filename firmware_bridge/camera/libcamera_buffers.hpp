#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <libcamera/camera.h>
#include <libcamera/framebuffer_allocator.h>
#include <libcamera/stream.h>

#include "firmware_bridge/camera/bayer.hpp"

namespace biotomy::bridge {

/// The memory of one stream's frames, mapped for reading; each file descriptor is mapped once,
/// whatever the number of planes in it. The camera allocates it, or where it cannot (libcamera's
/// virtual cameras, on a kernel without DMA heaps) it is ordinary memory of this process. The
/// camera must be configured.
class LibcameraBuffers {
 public:
  /// Throws DeviceError (configuration) if there is no memory or it can't be mapped.
  LibcameraBuffers(std::shared_ptr<libcamera::Camera> camera, libcamera::Stream* stream);
  ~LibcameraBuffers();
  LibcameraBuffers(const LibcameraBuffers&) = delete;
  LibcameraBuffers& operator=(const LibcameraBuffers&) = delete;

  const std::vector<std::unique_ptr<libcamera::FrameBuffer>>& all() const;

  /// Copies a filled buffer of that configuration out as R, G, B; `raw` is what is to be done to
  /// raw values. Throws PixelError.
  cv::Mat to_image(const libcamera::FrameBuffer& buffer,
                   const libcamera::StreamConfiguration& configuration,
                   const RawColours& raw) const;

 private:
  struct Mapping {
    int descriptor = -1;
    void* data = nullptr;
    std::size_t size = 0;
  };
  void make_own(const libcamera::StreamConfiguration& configuration);
  void map(const libcamera::FrameBuffer& buffer);
  void unmap_all();
  const Mapping& mapping_of(int descriptor) const;

  libcamera::Stream* stream_;
  std::unique_ptr<libcamera::FrameBufferAllocator> allocator_;
  std::vector<std::unique_ptr<libcamera::FrameBuffer>> own_;  ///< used when not empty
  std::vector<Mapping> mappings_;
};

}  // namespace biotomy::bridge
