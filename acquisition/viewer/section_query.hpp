#pragma once

#include <filesystem>
#include <initializer_list>
#include <map>
#include <optional>
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
void refuse_unknown(const Query& query, std::initializer_list<std::string_view> known);

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

/// As `biotomy section` understands it. Throws InvalidRequest.
reconstruct::SectionRequest section_request(const SectionQuery& query,
                                            const reconstruct::Cuboid& cuboid);

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
