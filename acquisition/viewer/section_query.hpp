#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>
#include <opencv2/core/types.hpp>

#include "reconstruct/section/section.hpp"
#include "reconstruct/section/section_image.hpp"
#include "reconstruct/section/section_parameters.hpp"

namespace biotomy::acquisition {

/// A query's parameters by name, decoded.
using Query = std::map<std::string, std::string>;

/// Throws InvalidRequest for a name that is none of `known`, with the one that was probably meant.
/// `v` and `generation`, with which pages make addresses differ, are always known.
void refuse_unknown(const Query& query, std::span<const std::string_view> known);

/// Takes what a query says under `name`, if it does.
void take(const Query& query, const std::string& name, std::string& text);
void take(const Query& query, const std::string& name, std::optional<std::string>& text);

/// What /section is asked for: the parameters of `biotomy section` under their names, and how the
/// picture is to come.
struct SectionQuery {
  reconstruct::PlaneText plane;
  reconstruct::SectionParameters parameters;
  std::string format = "png";  ///< png, jpeg or tiff
  std::string quality = "90";
  std::optional<cv::Size> fit;  ///< the picture is to be no larger
};

/// Throws InvalidRequest. What the texts mean is looked at later.
SectionQuery section_query(const Query& query);

/// The parameters of how a picture is drawn and sent, whatever its plane. Throws InvalidRequest.
SectionQuery style_query(const Query& query, const std::string& background);

/// As `biotomy section` understands it. Throws InvalidRequest.
reconstruct::SectionRequest section_request(const SectionQuery& query,
                                            const reconstruct::Cuboid& cuboid);

/// The least pixel, in micrometres, with which the rectangle has no more columns and rows.
double pixel_to_fit(const reconstruct::ThetaRectangle& rectangle, const cv::Size& fit);

/// The same query with a pixel of at least `least` micrometres: the next size that a person can
/// read.
SectionQuery with_pixel(const SectionQuery& query, double least,
                        const reconstruct::Vector3& spacing);

/// The same with a pixel as much larger as it takes to fit. Of the pixels that fit it is nearly the
/// least, but one that a person can read. Throws what outline_section throws.
SectionQuery fitted(const SectionQuery& query, const reconstruct::Cuboid& cuboid, int bits);

/// Throws InvalidRequest.
reconstruct::PictureFormat format_of(const std::string& format);

/// Of a file in that format: ".png", ".jpg" or ".tif".
std::string extension_of(reconstruct::PictureFormat format);
std::string content_type_of(reconstruct::PictureFormat format);

/// The command line that writes the picture of `query` without regard to `fit`, ready for a shell.
std::string section_command(const SectionQuery& query, const std::filesystem::path& sample);

/// What that command says of itself in the picture that it writes.
nlohmann::ordered_json section_command_parameters(const SectionQuery& query);

}  // namespace biotomy::acquisition
