#include "reconstruct/section/film.hpp"

#include <cmath>
#include <cstdlib>
#include <string>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <opencv2/core/utils/logger.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>
#include <unistd.h>

#include "reconstruct/errors.hpp"
#include "reconstruct/store/durable_file.hpp"
#include "reconstruct/store/file_descriptor.hpp"

namespace biotomy::reconstruct {
namespace {

constexpr double kLevels16To8 = 1.0 / 257.0;

// What goes wrong is told by an exception; OpenCV and FFmpeg would print it as well. OpenCV asks
// the environment once how loud FFmpeg may be; a value that the user has set stays.
void silence_ffmpeg() {
  constexpr const char* kQuiet = "-8";  // AV_LOG_QUIET
  static const int kSet = ::setenv("OPENCV_FFMPEG_LOGLEVEL", kQuiet, 0);
  static_cast<void>(kSet);
}

class SilentOpenCv {
 public:
  SilentOpenCv() : before_(cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT)) {
    silence_ffmpeg();
  }
  ~SilentOpenCv() { cv::utils::logging::setLogLevel(before_); }
  SilentOpenCv(const SilentOpenCv&) = delete;
  SilentOpenCv& operator=(const SilentOpenCv&) = delete;

 private:
  cv::utils::logging::LogLevel before_;
};

// Beside the film, and with its extension: that tells the back end the container.
std::filesystem::path partial_path_of(const std::filesystem::path& path) {
  std::string name = ".";
  name += path.stem().string();
  name += ".partial-" + std::to_string(::getpid()) + ".mp4";
  return path.parent_path() / name;
}

std::filesystem::path folder_of(const std::filesystem::path& path) {
  return path.has_parent_path() ? path.parent_path() : std::filesystem::path(".");
}

std::int64_t frames_in(const std::filesystem::path& path) {
  cv::VideoCapture film(path.string(), cv::CAP_FFMPEG);
  return film.isOpened() ? std::llround(film.get(cv::CAP_PROP_FRAME_COUNT)) : 0;
}

bool reaches_the_disk(const std::filesystem::path& path) {
  const FileDescriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
  return file.is_open() && ::fsync(file.get()) == 0;
}

}  // namespace

struct Film::Writer {
  cv::VideoWriter video;
};

void check_film_name(const std::filesystem::path& path) {
  if (path.extension() != ".mp4" || path.stem().empty()) {
    throw InvalidRequest("'" + path.string() + "' is no film that can be written: name it .mp4");
  }
}

Film::Film(std::filesystem::path path, double frames_per_second, cv::Size frame_size)
    : path_(std::move(path)),
      partial_path_(partial_path_of(path_)),
      frame_size_(frame_size),
      writer_(std::make_unique<Writer>()) {
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
  const SilentOpenCv silent;
  writer_->video.open(partial_path_.string(), cv::CAP_FFMPEG,
                      cv::VideoWriter::fourcc('a', 'v', 'c', '1'), frames_per_second, frame_size);
  if (!writer_->video.isOpened()) {
    std::error_code ignored;
    std::filesystem::remove(partial_path_, ignored);
    throw SampleError(path_.string() +
                      ": the film can't be begun: check that the folder can be written to and that "
                      "OpenCV's FFmpeg has an H.264 encoder");
  }
}

Film::~Film() {
  writer_.reset();  // closes the file before it is removed
  std::error_code ignored;
  std::filesystem::remove(partial_path_, ignored);
}

void Film::add(const cv::Mat& frame) {
  if (frame.size() != frame_size_) {
    throw InvalidRequest("a frame has not the size of the film");
  }
  cv::Mat levels;
  frame.convertTo(levels, CV_8U, frame.depth() == CV_16U ? kLevels16To8 : 1.0);
  cv::Mat bgr;
  cv::cvtColor(levels, bgr, cv::COLOR_RGB2BGR);
  writer_->video.write(bgr);
  ++frames_;
}

void Film::finish() {
  const SilentOpenCv silent;
  writer_->video.release();
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
  sync_folder(folder_of(path_));
}

}  // namespace biotomy::reconstruct
