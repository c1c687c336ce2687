// How fast pictures are encoded and decoded, against OpenCV's codecs over the same pixels, in one
// interleaved run: the ratio of our time to theirs (below 1 is faster), with its least and its
// largest, and the ratio of the sizes.
//
//   picture_bench [PHOTOGRAPH] [--side 4000] [--noise 2.0] [--rounds 7]

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <functional>
#include <iostream>
#include <span>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "reconstruct/picture/image_file.hpp"
#include "reconstruct/picture/jpeg_reader.hpp"
#include "reconstruct/picture/png_reader.hpp"
#include "reconstruct/section/section_image.hpp"

namespace {

using namespace biotomy::reconstruct;
using Clock = std::chrono::steady_clock;

struct Options {
  std::string photograph;
  int side = 4000;
  double noise = 2.0;
  int rounds = 7;
};

/// A picture as a section is: structures of several sizes, and a camera's noise.
cv::Mat made_up_picture(const Options& options) {
  cv::RNG random(42);
  cv::Mat sum(options.side, options.side, CV_32FC3, cv::Scalar(150, 100, 95));
  for (const int grain : {10, 60, 300}) {
    cv::Mat coarse(options.side / grain + 2, options.side / grain + 2, CV_32FC3);
    random.fill(coarse, cv::RNG::NORMAL, 0, 18);
    cv::Mat fine;
    cv::resize(coarse, fine, sum.size(), 0, 0, cv::INTER_CUBIC);
    sum += fine;
  }
  cv::Mat noise(sum.size(), CV_32FC3);
  random.fill(noise, cv::RNG::NORMAL, 0, options.noise);
  sum += noise;
  cv::Mat picture;
  sum.convertTo(picture, CV_8U);
  return picture;
}

double seconds_of(const std::function<void()>& work) {
  const auto start = Clock::now();
  work();
  return std::chrono::duration<double>(Clock::now() - start).count();
}

void compare(const char* what, int rounds, double size_ratio, const std::function<void()>& ours,
             const std::function<void()>& theirs) {
  std::vector<double> ratios;
  for (int round = 0; round < rounds; ++round) {
    const double our_seconds = seconds_of(ours);
    ratios.push_back(our_seconds / seconds_of(theirs));
  }
  std::sort(ratios.begin(), ratios.end());
  std::printf("%-22s %6.3f %6.3f … %.3f %8.3f\n", what, ratios[ratios.size() / 2], ratios.front(),
              ratios.back(), size_ratio);
  std::fflush(stdout);
}

void compare_encoders(const char* what, const cv::Mat& rgb, PictureFormat format,
                      const std::string& extension, const std::vector<int>& parameters,
                      int rounds) {
  std::vector<std::byte> ours;
  std::vector<std::uint8_t> theirs;
  const auto encode = [&] { ours = encode_section_image(rgb, format, {1.0, "", ""}); };
  const auto their_encode = [&] {
    cv::Mat bgr;
    cv::cvtColor(rgb, bgr, cv::COLOR_RGB2BGR);
    cv::imencode(extension, bgr, theirs, parameters);
  };
  encode();
  their_encode();
  compare(what, rounds, static_cast<double>(ours.size()) / static_cast<double>(theirs.size()),
          encode, their_encode);
}

void compare_decoders(const char* what, const cv::Mat& rgb, const std::string& extension,
                      cv::Mat (*decode)(std::span<const std::byte>), int rounds) {
  std::vector<std::uint8_t> file;
  cv::imencode(extension, rgb, file);
  compare(
      what, rounds, 1.0, [&] { decode(std::as_bytes(std::span(file))); },
      [&] {
        cv::Mat picture = cv::imdecode(file, cv::IMREAD_UNCHANGED);
        cv::cvtColor(picture, picture, cv::COLOR_BGR2RGB);
      });
}

void run(const Options& options) {
  const cv::Mat rgb =
      options.photograph.empty() ? made_up_picture(options) : read_image_file(options.photograph);
  cv::Mat deep;
  rgb.convertTo(deep, CV_16U, 257.0);
  cv::Mat noise(deep.size(), CV_16UC3);
  cv::randu(noise, cv::Scalar::all(0), cv::Scalar::all(257));
  deep += noise;
  std::printf("%d x %d\n%-22s %6s %16s %8s\n", rgb.cols, rgb.rows, "", "time", "spread", "size");
  const int deflate = 8;  // TIFF's COMPRESSION_ADOBE_DEFLATE
  compare_encoders("PNG, 8 bits", rgb, PictureFormat::png, ".png", {}, options.rounds);
  compare_encoders("PNG, 16 bits", deep, PictureFormat::png, ".png", {}, options.rounds);
  compare_encoders("TIFF, 8 bits", rgb, PictureFormat::tiff, ".tif",
                   {cv::IMWRITE_TIFF_COMPRESSION, deflate}, options.rounds);
  compare_encoders("JPEG, quality 90", rgb, PictureFormat::jpeg, ".jpg",
                   {cv::IMWRITE_JPEG_QUALITY, 90}, options.rounds);
  compare_decoders("reading PNG, 8 bits", rgb, ".png", decode_png, options.rounds);
  compare_decoders("reading PNG, 16 bits", deep, ".png", decode_png, options.rounds);
  compare_decoders(
      "reading JPEG", rgb, ".jpg",
      [](std::span<const std::byte> file) { return decode_jpeg(file); }, options.rounds);
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Measures our pictures' codecs against OpenCV's."};
  Options options;
  app.add_option("PHOTOGRAPH", options.photograph, "Of which kind pictures are [made up]");
  app.add_option("--side", options.side, "Of the made-up picture, pixels");
  app.add_option("--noise", options.noise, "Standard deviation of the made-up camera's noise");
  app.add_option("--rounds", options.rounds, "For each figure");
  CLI11_PARSE(app, argc, argv);
  try {
    run(options);
  } catch (const std::exception& error) {
    std::cerr << "picture_bench: " << error.what() << '\n';
    return 1;
  }
  return 0;
}
