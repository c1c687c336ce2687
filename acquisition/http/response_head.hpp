#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "acquisition/http/message.hpp"

namespace biotomy::acquisition {

/// The head of a response as HTTP/1.1 writes it, with its empty line. `length` is the body's;
/// nothing when the body ends with the connection, which is then not kept.
std::string response_head(const ApiResponse& response, std::optional<std::uint64_t> length,
                          bool keep_alive);

}  // namespace biotomy::acquisition
