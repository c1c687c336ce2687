#pragma once

#include <string>

namespace biotomy::acquisition {

/// The states of a job and what leads from one to the other, as a page in Markdown with a drawing
/// in Mermaid's language, made from the table of transitions: docs/job-states.md.
std::string state_diagram();

}  // namespace biotomy::acquisition
