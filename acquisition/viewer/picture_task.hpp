#pragma once

#include <memory>
#include <string>

#include <nlohmann/json.hpp>
#include <oneapi/tbb/task_arena.h>

#include "acquisition/http/message.hpp"
#include "acquisition/viewer/live_sample.hpp"
#include "reconstruct/section/section.hpp"
#include "reconstruct/section/section_image.hpp"

namespace biotomy::acquisition {

/// The most pixels of a picture that is answered at once: what is larger is an export.
inline constexpr std::int64_t kMostPixelsAtOnce = 32'000'000;

/// The sample with at least a layer. Throws Refusal with 409 where there is none yet, and what
/// LiveSample::look throws.
std::shared_ptr<const SampleView> look_at_layers(LiveSample& live);

/// A picture that was asked for, before a pixel of it is sampled.
struct PictureTask {
  std::shared_ptr<const SampleView> view;
  reconstruct::SectionRequest request;
  reconstruct::SectionOutline outline;
  reconstruct::PixelGrid full;  ///< were it not made to fit
  reconstruct::PictureFormat format = reconstruct::PictureFormat::png;
  int quality = reconstruct::kDefaultJpegQuality;
  nlohmann::ordered_json parameters;  ///< as a command writes them into the picture
  std::string command;                ///< makes the picture at full resolution
  std::string command_here;           ///< makes this one
};

/// A section of any size: whether it can be made is looked at by whoever makes it. Throws what
/// reconstruct::outline_section throws.
reconstruct::SectionOutline outline_of_any_size(const SampleView& view,
                                                reconstruct::SectionRequest request);

/// The picture, with its record in the header Biotomy-Section. Throws Refusal with 413 for too
/// large a one, SampleError, and Interrupted when the client has left or it took too long.
ApiResponse picture_of(const PictureTask& task, const ApiRequest& request, tbb::task_arena& arena);

/// The record alone.
ApiResponse outline_of(const PictureTask& task);

}  // namespace biotomy::acquisition
