#pragma once

#include <exception>
#include <iostream>
#include <string>

#include "reconstruct/errors.hpp"

namespace biotomy::bench {

/// Runs a program's work; what it throws becomes one line on stderr, and 2 for wrong usage, else 1.
template <typename Work>
int exit_code_of(const std::string& program, const Work& work) {
  try {
    work();
    return 0;
  } catch (const reconstruct::InvalidRequest& error) {
    std::cerr << program << ": " << error.what() << '\n';
    return 2;
  } catch (const std::exception& error) {
    std::cerr << program << ": " << error.what() << '\n';
    return 1;
  }
}

}  // namespace biotomy::bench
