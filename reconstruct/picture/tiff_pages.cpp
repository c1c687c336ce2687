#include "reconstruct/picture/tiff_pages.hpp"

#include <charconv>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "reconstruct/picture/tiff_file.hpp"

namespace biotomy::reconstruct {
namespace {

constexpr const char* kNoPicture = "holds no picture, only smaller copies or masks of one";

bool is_picture(const TiffFile& file) {
  const auto kind = file.number<std::uint32_t>(TIFFTAG_SUBFILETYPE, 0);
  return (kind & (FILETYPE_REDUCEDIMAGE | FILETYPE_MASK)) == 0;
}

/// Goes from page to page: libtiff would begin at the first one for each that it is asked for by
/// its number.
void for_each_picture(const TiffFile& file, const std::function<void(TiffPage)>& found) {
  for (;;) {
    if (is_picture(file)) {
      found(TIFFCurrentDirOffset(file.get()));
    }
    if (TIFFLastDirectory(file.get()) != 0) {
      return;
    }
    if (TIFFReadDirectory(file.get()) == 0) {
      file.fail("is damaged: the page behind its page " +
                std::to_string(TIFFCurrentDirectory(file.get()) + 1) + " cannot be read");
    }
  }
}

/// The whole number that stands behind the first `name` in a text; 1 where there is none.
std::int64_t number_behind(std::string_view name, std::string_view text) {
  const std::size_t place = text.find(name);
  std::int64_t number = 1;
  if (place != std::string_view::npos) {
    const std::string_view digits = text.substr(place + name.size());
    std::from_chars(digits.data(), digits.data() + digits.size(), number);
  }
  return number;
}

/// What programs write into the description of the first page.
struct Declared {
  std::int64_t images = 1;
  std::int64_t channels = 1;
};

Declared declared_by(const std::string& description) {
  if (description.starts_with("ImageJ=")) {
    return {number_behind("\nimages=", description), number_behind("\nchannels=", description)};
  }
  return {1, number_behind(" SizeC=\"", description)};
}

}  // namespace

void go_to_only_picture(const TiffFile& file) {
  std::optional<TiffPage> picture;
  for_each_picture(file, [&](TiffPage page) {
    if (picture) {
      file.fail(
          "holds more than one picture: give this file alone, whose pages are the layers then, or "
          "split it into files of one picture each, numbered by their layers");
    }
    picture = page;
  });
  if (!picture) {
    file.fail(kNoPicture);
  }
  if (*picture != TIFFCurrentDirOffset(file.get())) {
    go_to_page(file, *picture);
  }
}

void go_to_page(const TiffFile& file, TiffPage page) {
  if (TIFFSetSubDirectory(file.get(), page) == 0) {
    file.fail("is damaged: a page of it cannot be read");
  }
}

std::vector<TiffPage> pages_of_stack(const std::filesystem::path& path) {
  const TiffFile file = TiffFile::open(path);
  const Declared declared = declared_by(file.text(TIFFTAG_IMAGEDESCRIPTION).value_or(""));
  const bool grey = file.number<std::uint16_t>(TIFFTAG_SAMPLESPERPIXEL, 1) == 1;
  std::vector<TiffPage> pages;
  for_each_picture(file, [&](TiffPage page) { pages.push_back(page); });
  if (pages.empty()) {
    file.fail(kNoPicture);
  }
  if (declared.images > static_cast<std::int64_t>(pages.size())) {
    file.fail("says that it holds " + std::to_string(declared.images) + " images and has " +
              std::to_string(pages.size()) + (pages.size() == 1 ? " page" : " pages") +
              ", as ImageJ saves stacks of more than 4 GiB: save it as an image sequence");
  }
  if (grey && declared.channels > 1 && pages.size() > 1) {
    file.fail("has each of its " + std::to_string(declared.channels) +
              " colours as a page of its own: convert it to RGB");
  }
  return pages;
}

}  // namespace biotomy::reconstruct
