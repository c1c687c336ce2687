#include "reconstruct/store/metadata_json.hpp"

#include <cstddef>
#include <set>
#include <vector>

#include "reconstruct/errors.hpp"
#include "reconstruct/excerpt.hpp"

namespace biotomy::reconstruct {
namespace {

using nlohmann::json;

constexpr int kDeepest = 32;  // comparing and printing values recurse

/// Looks at each event of the parser before a value is built from it.
class Guard {
 public:
  void see(int depth, json::parse_event_t event, const json& value) {
    switch (event) {
      case json::parse_event_t::object_start:
        keys_.emplace_back();
        [[fallthrough]];
      case json::parse_event_t::array_start:
        if (depth >= kDeepest) {
          throw SampleError("its values are nested deeper than " + std::to_string(kDeepest));
        }
        break;
      case json::parse_event_t::object_end:
        keys_.pop_back();
        break;
      case json::parse_event_t::key:
        if (!keys_.back().insert(value.get_ref<const std::string&>()).second) {
          throw SampleError("the key '" + excerpt(value.get_ref<const std::string&>()) +
                            "' stands twice in one object");
        }
        break;
      default:
        break;
    }
  }

 private:
  std::vector<std::set<std::string>> keys_;  // of the objects that are open
};

}  // namespace

json parse_metadata_json(const std::string& text) {
  if (text.size() > kMostMetadataBytes) {
    throw SampleError("it has " + std::to_string(text.size()) + " bytes, metadata has at most " +
                      std::to_string(kMostMetadataBytes));
  }
  Guard guard;
  try {
    return json::parse(text, [&](int depth, json::parse_event_t event, json& value) {
      guard.see(depth, event, value);
      return true;
    });
  } catch (const json::parse_error& error) {  // whose own words quote the file at any length
    throw SampleError("it is not JSON: wrong at byte " + std::to_string(error.byte));
  } catch (const json::out_of_range&) {
    throw SampleError("it holds a number that is too large");
  }
}

std::int64_t whole_number(const json& value, const std::string& what, std::int64_t least,
                          std::int64_t most) {
  const bool fits = value.is_number_unsigned()
                        ? value.get<std::uint64_t>() <= static_cast<std::uint64_t>(most)
                        : value.is_number_integer();
  const std::int64_t number = fits ? value.get<std::int64_t>() : 0;
  if (!fits || number < least || number > most) {
    throw SampleError(what + " must be a whole number from " + std::to_string(least) + " to " +
                      std::to_string(most));
  }
  return number;
}

}  // namespace biotomy::reconstruct
