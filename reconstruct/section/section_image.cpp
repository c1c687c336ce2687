#include "reconstruct/section/section_image.hpp"

#include <algorithm>
#include <cctype>
#include <string>

#include "reconstruct/disk/durable_file.hpp"
#include "reconstruct/errors.hpp"
#include "reconstruct/picture/png_writer.hpp"
#include "reconstruct/picture/tiff_writer.hpp"

namespace biotomy::reconstruct {

PictureFormat picture_format(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char letter) { return static_cast<char>(std::tolower(letter)); });
  if (extension == ".png") {
    return PictureFormat::png;
  }
  if (extension == ".tif" || extension == ".tiff") {
    return PictureFormat::tiff;
  }
  if (extension == ".jpg" || extension == ".jpeg") {
    return PictureFormat::jpeg;
  }
  throw InvalidRequest("'" + path.string() +
                       "' is no picture that can be written: name it .png, .tif or .jpg");
}

std::vector<std::byte> encode_section_image(const cv::Mat& image, PictureFormat format,
                                            const PictureNotes& notes, int jpeg_quality) {
  switch (format) {
    case PictureFormat::png:
      return encode_png(image, notes);
    case PictureFormat::tiff:
      return encode_tiff(image, notes);
    case PictureFormat::jpeg:
      return encode_jpeg(image, notes, jpeg_quality);
  }
  throw InvalidRequest("there is no such format of pictures");
}

void write_section_image(const std::filesystem::path& path, const cv::Mat& image,
                         const PictureNotes& notes, int jpeg_quality) {
  write_durably(path, encode_section_image(image, picture_format(path), notes, jpeg_quality));
}

}  // namespace biotomy::reconstruct
