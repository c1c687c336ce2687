#pragma once

#include "acquisition/http/message.hpp"
#include "reconstruct/interruption.hpp"

namespace biotomy::acquisition {

/// Of one answer, seconds: whatever takes longer is not for a person who waits.
inline constexpr int kLongestAnswer = 20;

/// True once the client has left or the time that an answer may take, from now on, is over.
reconstruct::StopRequested time_allowed(const ApiRequest& request);

}  // namespace biotomy::acquisition
