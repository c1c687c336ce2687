#pragma once

#include <string>

namespace biotomy::bridge::testing {

/// What an Error thrown by `act` says; "(nothing was thrown)" if there is none.
template <class Error, class Act>
std::string thrown_message(Act act) {
  try {
    act();
  } catch (const Error& error) {
    return error.what();
  }
  return "(nothing was thrown)";
}

}  // namespace biotomy::bridge::testing
