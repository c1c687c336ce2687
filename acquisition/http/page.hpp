#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>

#include "acquisition/http/message.hpp"
#include "acquisition/http/page_asset.hpp"

namespace biotomy::acquisition {

/// The files of the page. They hold nothing of the rig or a sample, so that everybody may have
/// them: the page itself asks for the token where one is needed. Safe for many threads.
class Page {
 public:
  /// What the assets point to outlives it.
  explicit Page(std::span<const PageAsset> assets);

  /// Whether the path is the page's: "/", "/assets/…" or another of its files.
  bool answers(const ApiRequest& request) const;

  ApiResponse answer(const ApiRequest& request) const;

 private:
  struct File {
    PageAsset asset;
    std::string tag;  ///< the ETag, of its content
  };
  std::map<std::string, File, std::less<>> files_;
};

/// The page of a program that was built without one.
std::string no_page_html();

}  // namespace biotomy::acquisition
