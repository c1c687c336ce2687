#include "acquisition/service/access.hpp"

#include <utility>

#include "reconstruct/excerpt.hpp"

namespace biotomy::acquisition {
namespace {

constexpr std::string_view kScheme = "Bearer ";

Ruling refused(int status, std::string sentence) {
  return {.granted = false,
          .who = {},
          .status = status,
          .sentence = std::move(sentence),
          .retry_after = std::chrono::seconds(0)};
}

Ruling too_many(const std::string& what, std::chrono::milliseconds wait) {
  const auto seconds = std::chrono::ceil<std::chrono::seconds>(wait);
  Ruling ruling = refused(429, "too many " + what + " from this address: try again in " +
                                   std::to_string(seconds.count()) + " s");
  ruling.retry_after = seconds;
  return ruling;
}

}  // namespace

Access::Access(Credentials credentials, const AccessSettings& settings, Clock clock,
               Refused refused)
    : credentials_(std::move(credentials)),
      settings_(settings),
      clock_(std::move(clock)),
      refused_(std::move(refused)),
      failures_(RateLimit::per_minute(settings.failed_tokens_per_minute)),
      commands_(RateLimit::per_minute(settings.commands_per_minute)) {}

Ruling Access::reading(const std::string& client, std::string_view authorization,
                       const std::string& what) {
  if (!settings_.reading_needs_token) return {.granted = true, .who = client, .sentence = {}};
  const std::scoped_lock lock(mutex_);
  const TimePoint now = clock_();
  return recorded(identify(client, authorization, now), client, what, now);
}

Ruling Access::command(const std::string& client, std::string_view authorization,
                       const std::string& what) {
  const std::scoped_lock lock(mutex_);
  const TimePoint now = clock_();
  Ruling ruling = identify(client, authorization, now);
  if (ruling.granted) {
    if (const auto wait = commands_.take(client, now)) ruling = too_many("commands", *wait);
  }
  return recorded(std::move(ruling), client, what, now);
}

Ruling Access::identify(const std::string& client, std::string_view authorization, TimePoint now) {
  if (authorization.substr(0, kScheme.size()) != kScheme) {
    return refused(401, "this needs the header Authorization: Bearer <token>");
  }
  if (const auto wait = failures_.wait_of(client, now)) return too_many("wrong tokens", *wait);
  const auto owner = credentials_.owner_of(authorization.substr(kScheme.size()));
  if (!owner) {
    failures_.take(client, now);
    return refused(403, "this is not a token of this rig");
  }
  return {.granted = true, .who = *owner + " from " + client, .sentence = {}};
}

Ruling Access::recorded(Ruling ruling, const std::string& client, const std::string& what,
                        TimePoint now) {
  if (ruling.granted) return ruling;
  const std::string reason = ruling.status == 401   ? "no token"
                             : ruling.status == 403 ? "a wrong token"
                                                    : "too many attempts";
  // Anybody may ask for anything, and every line of it is kept in the journal.
  const std::string asked = reconstruct::excerpt(what);
  if (const auto line = refusals_.line(client, asked + ", " + reason, now)) refused_(*line);
  return ruling;
}

}  // namespace biotomy::acquisition
