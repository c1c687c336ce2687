// In place of the page's files, where the program is built without them.
#include "acquisition/http/page_asset.hpp"

namespace biotomy::acquisition {

std::span<const PageAsset> page_assets() {
  return {};
}

}  // namespace biotomy::acquisition
