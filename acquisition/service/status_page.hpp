#pragma once

#include <string>

#include "acquisition/job/job_status.hpp"

namespace biotomy::acquisition {

/// A page that shows the status and renews itself. It needs nothing but itself: no script, no other
/// file.
std::string status_page(const JobStatus& status);

/// `text` with the characters that mean something in HTML written out.
std::string html_escaped(const std::string& text);

}  // namespace biotomy::acquisition
