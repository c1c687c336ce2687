#pragma once

#include <span>
#include <string_view>

namespace biotomy::acquisition {

/// A file of the page, as it was built.
struct PageAsset {
  std::string_view path;  ///< as it is asked for: "/index.html", "/assets/main-3f2a.js"
  std::string_view content_type;
  std::string_view gzip;  ///< the file, compressed
};

/// The files of the page that this program was built with; none when it was built without.
/// "/index.html" is the page itself; the names of those under "/assets/" change with their content.
std::span<const PageAsset> page_assets();

}  // namespace biotomy::acquisition
