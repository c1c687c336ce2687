#include "firmware_bridge/camera/pixel_formats.hpp"

#include <array>
#include <span>
#include <string>
#include <utility>

#include <opencv2/imgproc.hpp>

#include "reconstruct/errors.hpp"
#include "reconstruct/picture/jpeg_reader.hpp"

namespace biotomy::bridge {

namespace {

/// The plane as a Mat over its bytes, once they are known to be enough for `rows` × `columns`.
cv::Mat view(const PixelPlane& plane, int rows, int columns, int type) {
  const std::size_t row_bytes = static_cast<std::size_t>(columns) * CV_ELEM_SIZE(type);
  const std::size_t needed = static_cast<std::size_t>(rows - 1) * plane.stride + row_bytes;
  if (plane.stride < row_bytes || plane.bytes.size() < needed) {
    throw PixelError("a frame of " + std::to_string(plane.bytes.size()) + " bytes with rows of " +
                     std::to_string(plane.stride) + " is too short for " + std::to_string(rows) +
                     " rows of " + std::to_string(row_bytes) + " bytes");
  }
  // OpenCV has no Mat of constant data; it is only read.
  return {rows, columns, type, const_cast<std::uint8_t*>(plane.bytes.data()), plane.stride};
}

/// The weights of red and blue in Y.
std::pair<double, double> luma_weights(YuvMatrix matrix) {
  switch (matrix) {
    case YuvMatrix::bt601:
      return {0.299, 0.114};
    case YuvMatrix::bt709:
      return {0.2126, 0.0722};
    case YuvMatrix::bt2020:
      return {0.2627, 0.0593};
  }
  throw PixelError("a frame of an unknown colour space");
}

/// 3 × 4: from (Y, U, V, 1) of 8 bits to R, G, B.
cv::Matx34d rgb_from_yuv(const YuvCoding& coding) {
  const auto [red, blue] = luma_weights(coding.matrix);
  const double green = 1.0 - red - blue;
  const bool is_full = coding.range == YuvRange::full;
  const double black = is_full ? 0.0 : 16.0;
  const double luma = is_full ? 1.0 : 255.0 / 219.0;
  const double chroma = is_full ? 1.0 : 255.0 / 224.0;
  const double red_v = 2.0 * (1.0 - red) * chroma;
  const double blue_u = 2.0 * (1.0 - blue) * chroma;
  const double green_u = -blue_u * blue / green;
  const double green_v = -red_v * red / green;
  constexpr double kGray = 128.0;
  return {luma, 0.0,     red_v,   -luma * black - kGray * red_v,
          luma, green_u, green_v, -luma * black - kGray * (green_u + green_v),
          luma, blue_u,  0.0,     -luma * black - kGray * blue_u};
}

/// Y at full size, U and V at a lower one, in any coding. OpenCV's own conversions from subsampled
/// formats, much faster, know BT.601 with the limited range alone.
cv::Mat yuv_to_rgb(const cv::Mat& y, const cv::Mat& u, const cv::Mat& v, const YuvCoding& coding) {
  cv::Mat full_u;
  cv::Mat full_v;
  cv::resize(u, full_u, y.size(), 0, 0, cv::INTER_NEAREST);
  cv::resize(v, full_v, y.size(), 0, 0, cv::INTER_NEAREST);
  cv::Mat merged;
  cv::merge(std::array{y, full_u, full_v}, merged);
  cv::Mat rgb;
  cv::transform(merged, rgb, rgb_from_yuv(coding));
  return rgb;
}

cv::Mat nv12_to_rgb(int width, int height, std::span<const PixelPlane> planes,
                    const YuvCoding& coding) {
  if (width % 2 != 0 || height % 2 != 0) {
    throw PixelError("an NV12 frame needs an even width and height");
  }
  PixelPlane chroma;
  if (planes.size() > 1) {
    chroma = planes[1];
  } else {
    const std::size_t luma_bytes = planes[0].stride * static_cast<std::size_t>(height);
    if (planes[0].bytes.size() < luma_bytes) throw PixelError("an NV12 frame without its colours");
    chroma = {planes[0].bytes.subspan(luma_bytes), planes[0].stride};
  }
  const cv::Mat y = view(planes[0], height, width, CV_8UC1);
  const cv::Mat uv = view(chroma, height / 2, width / 2, CV_8UC2);
  cv::Mat rgb;
  if (coding == YuvCoding{}) {
    cv::cvtColorTwoPlane(y, uv, rgb, cv::COLOR_YUV2RGB_NV12);
    return rgb;
  }
  std::array<cv::Mat, 2> parts;
  cv::split(uv, parts.data());
  return yuv_to_rgb(y, parts[0], parts[1], coding);
}

cv::Mat yuyv_to_rgb(int width, int height, const PixelPlane& plane, const YuvCoding& coding) {
  if (width % 2 != 0) throw PixelError("a YUYV frame needs an even width");
  cv::Mat rgb;
  if (coding == YuvCoding{}) {
    cv::cvtColor(view(plane, height, width, CV_8UC2), rgb, cv::COLOR_YUV2RGB_YUYV);
    return rgb;
  }
  const cv::Mat pairs = view(plane, height, width / 2, CV_8UC4);
  cv::Mat y;
  cv::extractChannel(view(plane, height, width, CV_8UC2), y, 0);
  cv::Mat u;
  cv::Mat v;
  cv::extractChannel(pairs, u, 1);
  cv::extractChannel(pairs, v, 3);
  return yuv_to_rgb(y, u, v, coding);
}

cv::Mat mjpeg_to_rgb(int width, int height, const PixelPlane& plane) {
  // Cameras pad the file with zeros. Without its end marker a JPEG was cut off, and a decoder would
  // fill the rest with gray and say nothing.
  std::span<const std::uint8_t> file = plane.bytes;
  while (!file.empty() && file.back() == 0) file = file.first(file.size() - 1);
  if (file.size() < 4 || file[0] != 0xFF || file[1] != 0xD8 || file[file.size() - 2] != 0xFF ||
      file.back() != 0xD9) {
    throw PixelError("a frame that is no whole JPEG");
  }
  cv::Mat rgb;
  try {
    rgb = reconstruct::decode_jpeg(std::as_bytes(file), reconstruct::ExtraneousBytes::are_ignored);
  } catch (const reconstruct::SampleError& error) {
    throw PixelError(std::string("a frame whose JPEG ") + error.what());
  }
  if (rgb.cols != width || rgb.rows != height) {
    throw PixelError("a JPEG of " + std::to_string(rgb.cols) + " x " + std::to_string(rgb.rows) +
                     " pixels in a frame of " + std::to_string(width) + " x " +
                     std::to_string(height));
  }
  return rgb;
}

cv::Mat convert(PixelFormat format, int width, int height, std::span<const PixelPlane> planes,
                const YuvCoding& coding) {
  switch (format) {
    case PixelFormat::rgb24:
      return view(planes[0], height, width, CV_8UC3).clone();
    case PixelFormat::bgr24: {
      cv::Mat rgb;
      cv::cvtColor(view(planes[0], height, width, CV_8UC3), rgb, cv::COLOR_BGR2RGB);
      return rgb;
    }
    case PixelFormat::nv12:
      return nv12_to_rgb(width, height, planes, coding);
    case PixelFormat::yuyv:
      return yuyv_to_rgb(width, height, planes[0], coding);
    case PixelFormat::mjpeg:
      return mjpeg_to_rgb(width, height, planes[0]);
  }
  throw PixelError("a frame of an unknown pixel format");
}

}  // namespace

cv::Mat to_rgb(PixelFormat format, int width, int height, std::span<const PixelPlane> planes,
               const YuvCoding& coding) {
  if (width < 1 || height < 1 || planes.empty()) throw PixelError("a frame without pixels");
  try {
    return convert(format, width, height, planes, coding);
  } catch (const cv::Exception& error) {
    throw PixelError("a frame that OpenCV cannot convert: " + error.err);
  }
}

}  // namespace biotomy::bridge
