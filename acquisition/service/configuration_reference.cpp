#include "acquisition/service/configuration_reference.hpp"

#include <map>
#include <sstream>

#include "acquisition/service/configuration.hpp"

namespace biotomy::acquisition {
namespace {

const char* about(const std::string& table) {
  static const std::map<std::string, const char*> abouts = {
      {"job", "What is ground and photographed."},
      {"stage", "The controller of the grinding stage, over Modbus."},
      {"lines", "The digital lines. E-stop and door are inputs, the others outputs."},
      {"lines.estop", "Of the gpiod backend: active when the e-stop is pressed."},
      {"lines.door", "Of the gpiod backend: active when the door is open."},
      {"lines.lamp", "Of the gpiod backend."},
      {"lines.trigger", "A line of this computer for camera.sync; may be left out."},
      {"lines.tower_light", "Of the gpiod backend; may be left out. Lit while an alarm waits."},
      {"camera", "The camera and how it takes a frame."},
      {"calibration", "What biotomy calibrate records, and whether frames are corrected by it."},
      {"focus", "How the focus follows the face and is searched."},
      {"quality", "When a frame is good enough, and what is done when it is not."},
      {"store", "How images and volume are kept."},
      {"safety", "Beyond these limits the wheel stops and a person is called."},
      {"service", "The web page, the HTTP API and the daemon itself."},
      {"notify",
       "Whom the daemon tells when a person is needed, and when the job is done; see operation.md. "
       "Without a command and a webhook it tells nobody."},
  };
  const auto found = abouts.find(table);
  return found == abouts.end() ? "" : found->second;
}

/// A cell of a Markdown table; an empty one is a dash.
std::string cell(const std::string& text) {
  if (text.empty()) return "–";
  std::string escaped;
  for (const char character : text) {
    if (character == '|') escaped += '\\';
    escaped += character;
  }
  return escaped;
}

std::string code(const std::string& text) {
  return text.empty() ? "" : "`" + text + "`";
}

}  // namespace

std::string configuration_reference() {
  std::ostringstream text;
  text << "# The configuration: rig.toml\n\n"
          "`biotomyd --config rig.toml` reads one TOML file. Every key is below; a key that is not "
          "is an error that\nnames the nearest one. Relative paths are relative to the file's "
          "folder. A key without a default is\nrequired. This page is what `biotomyd "
          "--configuration-reference` prints.\n\n"
          "The least that must be said:\n\n```toml\n"
       << smallest_configuration() << "```\n";
  std::string table;
  for (const bridge::DeclaredKey& key : known_keys()) {
    if (key.table != table) {
      table = key.table;
      text << "\n## [" << table << "]\n\n"
           << about(table)
           << "\n\n| key | type | default | unit | allowed | meaning |\n| --- | --- | --- | --- | "
              "--- | --- |\n";
    }
    text << "| " << code(key.name) << " | " << key.type << " | "
         << (key.default_value.empty() ? "required" : cell(code(key.default_value))) << " | "
         << cell(key.unit) << " | " << cell(key.allowed) << " | " << cell(key.description)
         << " |\n";
  }
  return text.str();
}

}  // namespace biotomy::acquisition
