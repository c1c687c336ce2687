#include "reconstruct/section/film.hpp"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include "reconstruct/disk/durable_file.hpp"
#include "reconstruct/errors.hpp"
#include "reconstruct/picture/rgb_picture.hpp"

namespace biotomy::reconstruct {
namespace {

constexpr double kLevels16To8 = 1.0 / 257.0;
constexpr int kBlock = 16;
constexpr int kMostBlocks = 36864;
constexpr int kMostBlocksAlongASide = 543;
// Constant rate factor, from 0 to 51: 17 or 18 is said to be where the eye sees no loss; these
// films are stopped and looked at frame by frame.
constexpr const char* kRateFactor = "16";
constexpr const char* kFramesBetweenKeyFrames = "30";  // so that players find any frame at once

std::filesystem::path folder_of(const std::filesystem::path& path) {
  return path.has_parent_path() ? path.parent_path() : std::filesystem::path(".");
}

std::filesystem::path partial_path_of(const std::filesystem::path& path) {
  return path.parent_path() / ("." + path.filename().string() + ".partial");
}

// ffmpeg takes a name with a colon or a dash in front for something else.
std::string file_argument(const std::filesystem::path& path) {
  return "file:" + path.string();
}

std::string size_argument(cv::Size size, char between) {
  return std::to_string(size.width) + between + std::to_string(size.height);
}

/// The shortest decimal number that is this rate: "25", "29.97".
std::string rate_argument(double rate) {
  std::string text(32, '\0');
  const auto end = std::to_chars(text.data(), text.data() + text.size(), rate).ptr;
  text.resize(static_cast<std::size_t>(end - text.data()));
  return text;
}

std::vector<std::string> encoder_command(const std::filesystem::path& path, double rate,
                                         cv::Size frame_size) {
  // The colours are converted by the matrix that players assume, and the frames say so, so that
  // the encoder and the file do.
  const std::string picture =
      "scale=" + size_argument(film_size(frame_size), ':') +
      ":flags=area+accurate_rnd+full_chroma_int:out_color_matrix=bt709:out_range=tv,"
      "format=yuv420p,setparams=range=tv:colorspace=bt709:color_primaries=bt709:"
      "color_trc=iec61966-2-1";
  return {"ffmpeg", "-hide_banner", "-nostdin", "-loglevel", "error",
          // What comes in.
          "-f", "rawvideo", "-pixel_format", "rgb24", "-video_size", size_argument(frame_size, 'x'),
          "-framerate", rate_argument(rate), "-i", "pipe:0",
          // What is made of it.
          "-vf", picture, "-fps_mode", "passthrough", "-c:v", "libx264", "-preset", "medium",
          "-crf", kRateFactor, "-g", kFramesBetweenKeyFrames,
          // Where it goes.
          "-movflags", "+faststart", "-f", "mp4", "-y", file_argument(path)};
}

/// As the file's index says; 0 when it can't be read.
std::int64_t frames_in(const std::filesystem::path& path) {
  ChildProgram probe({"ffprobe", "-v", "error", "-select_streams", "v:0", "-show_entries",
                      "stream=nb_frames", "-of", "default=nokey=1:noprint_wrappers=1",
                      file_argument(path)});
  return probe.finish() == 0 ? std::strtoll(probe.output().c_str(), nullptr, 10) : 0;
}

bool reaches_the_disk(const std::filesystem::path& path) {
  const FileDescriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
  return file.is_open() && ::fsync(file.get()) == 0;
}

/// Makes the file and keeps others from writing the same film. The kernel takes the lock back when
/// we die; an encoder that outlives us for a moment goes on with a file that has lost its name.
FileDescriptor locked_file(const std::filesystem::path& partial,
                           const std::filesystem::path& film) {
  const FileDescriptor leftover(::open(partial.c_str(), O_RDONLY | O_NOFOLLOW | O_CLOEXEC));
  if (leftover.is_open() && ::flock(leftover.get(), LOCK_EX | LOCK_NB) != 0) {
    throw SampleError(film.string() + ": another process is writing this film: wait for its end");
  }
  ::unlink(partial.c_str());
  FileDescriptor file(::open(partial.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0644));
  if (!file.is_open() || ::flock(file.get(), LOCK_EX | LOCK_NB) != 0) {
    throw SampleError(film.string() +
                      ": the film can't be begun: " + std::generic_category().message(errno));
  }
  return file;
}

}  // namespace

void check_film_name(const std::filesystem::path& path) {
  if (path.extension() != ".mp4" || path.stem().empty()) {
    throw InvalidRequest("'" + path.string() + "' is no film that can be written: name it .mp4");
  }
}

cv::Size film_size(cv::Size frame_size) {
  const auto blocks = [](int length) { return (length + kBlock - 1) / kBlock; };
  const auto fits = [&](cv::Size size) {
    return std::max(blocks(size.width), blocks(size.height)) <= kMostBlocksAlongASide &&
           std::int64_t{blocks(size.width)} * blocks(size.height) <= kMostBlocks;
  };
  const auto even = [](double length) { return std::max(2, 2 * static_cast<int>(length / 2.0)); };
  cv::Size size = frame_size;
  for (double share = 1.0; !fits(size); share *= 0.99) {
    size = {even(share * frame_size.width), even(share * frame_size.height)};
  }
  return size;
}

Film::Film(std::filesystem::path path, double frames_per_second, cv::Size frame_size)
    : path_(std::move(path)), partial_path_(partial_path_of(path_)), frame_size_(frame_size) {
  check_film_name(path_);
  if (!std::isfinite(frames_per_second) || frames_per_second <= 0.0) {
    throw InvalidRequest("the frame rate of a film must be above 0");
  }
  if (frame_size.empty() || frame_size.width % 2 != 0 || frame_size.height % 2 != 0) {
    throw InvalidRequest("the frames of a film must have an even width and height");
  }
  if (!std::filesystem::is_directory(folder_of(path_))) {
    throw SampleError(path_.string() + ": there is no such folder to write the film to");
  }
  FileDescriptor lock = locked_file(partial_path_, path_);
  try {
    encoder_ = std::make_unique<ChildProgram>(
        encoder_command(partial_path_, frames_per_second, frame_size));
  } catch (const SampleError& error) {
    std::error_code ignored;
    std::filesystem::remove(partial_path_, ignored);
    throw SampleError(path_.string() + ": the film can't be begun: " + error.what());
  }
  lock_ = std::move(lock);
}

Film::~Film() {
  encoder_.reset();  // ends before its file is removed
  std::error_code ignored;
  if (lock_.is_open()) {
    std::filesystem::remove(partial_path_, ignored);
  }
}

void Film::fail() {
  const int code = encoder_->finish();
  const std::string words = encoder_->last_words();
  throw SampleError(path_.string() + ": ffmpeg " +
                    (code > 128 ? "was ended by signal " + std::to_string(code - 128)
                                : "failed after " + std::to_string(frames_) + " frames") +
                    (words.empty() ? "" : ": " + words));
}

void Film::add(const cv::Mat& frame) {
  require_rgb_picture(frame);
  if (frame.size() != frame_size_) {
    throw InvalidRequest("a frame has not the size of the film");
  }
  cv::Mat levels = frame;
  if (frame.depth() == CV_16U) {
    frame.convertTo(levels, CV_8U, kLevels16To8);
  } else if (!frame.isContinuous()) {
    levels = frame.clone();
  }
  const auto* bytes = reinterpret_cast<const std::byte*>(levels.data);
  if (!encoder_->feed({bytes, levels.total() * levels.elemSize()})) {
    fail();
  }
  ++frames_;
}

void Film::finish() {
  if (encoder_->finish() != 0) {
    fail();
  }
  const std::int64_t stored = frames_in(partial_path_);
  if (stored != frames_ || !reaches_the_disk(partial_path_)) {
    throw SampleError(path_.string() + ": the film has " + std::to_string(stored) + " of its " +
                      std::to_string(frames_) + " frames: is the disk full?");
  }
  std::error_code error;
  std::filesystem::rename(partial_path_, path_, error);
  if (error) {
    throw SampleError(path_.string() + ": the film can't be put in its place: " + error.message());
  }
  lock_ = FileDescriptor();  // nothing is left to be removed
  sync_folder(folder_of(path_));
}

}  // namespace biotomy::reconstruct
