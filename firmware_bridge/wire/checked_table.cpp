#include "firmware_bridge/wire/checked_table.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <optional>
#include <sstream>

#include <toml++/toml.h>

#include "firmware_bridge/wire/nearest_name.hpp"

namespace biotomy::bridge {

namespace {

/// Far above any file that a person writes, so that a wrong path (/dev/zero, a volume) ends at
/// once.
constexpr std::size_t kLargestFile = 4 << 20;

std::string joined(const std::string& table, const std::string& name) {
  return table.empty() ? name : table + "." + name;
}

/// The shortest decimal that reads back as the same number: 0.1, not 0.10000000000000001.
std::string shortest(double value) {
  std::ostringstream text;
  for (int digits = 6; digits <= 17; ++digits) {
    text.str("");
    text.precision(digits);
    text << value;
    if (std::strtod(text.str().c_str(), nullptr) == value) break;
  }
  return text.str();
}

std::string as_toml(double value) {
  std::string text = shortest(value);
  if (text.find_first_of(".en") == std::string::npos) text += ".0";
  return text;
}

std::string as_toml(const std::vector<double>& values) {
  std::string text = "[";
  for (const double value : values) text += (text.size() > 1 ? ", " : "") + as_toml(value);
  return text + "]";
}

std::string quoted(const std::string& text) {
  return "\"" + text + "\"";
}

std::string as_toml(const std::vector<std::string>& texts) {
  std::string text = "[";
  for (const std::string& one : texts) text += (text.size() > 1 ? ", " : "") + quoted(one);
  return text + "]";
}

/// "least to most", or whichever of the two is a limit; empty if neither is.
template <class Number, class Print>
std::string range_text(Number minimum, Number maximum, Print print) {
  const bool has_minimum = minimum > std::numeric_limits<Number>::lowest();
  const bool has_maximum = maximum < std::numeric_limits<Number>::max();
  if (has_minimum && has_maximum) return print(minimum) + " to " + print(maximum);
  if (has_minimum) return "at least " + print(minimum);
  if (has_maximum) return "at most " + print(maximum);
  return {};
}

std::string range_text(const IntegerKey& key) {
  return range_text(key.minimum, key.maximum, [](std::int64_t n) { return std::to_string(n); });
}
std::string range_text(double minimum, double maximum) {
  return range_text(minimum, maximum, shortest);
}

std::string choices_text(const std::vector<std::string>& choices) {
  std::string text;
  for (std::size_t i = 0; i < choices.size(); ++i) {
    if (i > 0) text += i + 1 == choices.size() ? " or " : ", ";
    text += quoted(choices[i]);
  }
  return text;
}

/// "a number, 1 to 100 (mm)"
std::string expected(const std::string& kind, const std::string& range, const std::string& unit) {
  std::string text = "expected " + kind;
  if (!range.empty()) text += ", " + range;
  if (!unit.empty()) text += " (" + unit + ")";
  return text;
}

}  // namespace

struct CheckedTable::Document {
  std::string source;
  std::filesystem::path folder;
  toml::table root;
  bool is_reference = false;
  std::vector<DeclaredKey> declared;
  std::vector<std::string> tables;  ///< paths of the tables asked for

  const toml::table* table_at(const std::string& path) const {
    const toml::table* table = &root;
    std::istringstream names(path);
    for (std::string name; table != nullptr && std::getline(names, name, '.');) {
      table = table->get_as<toml::table>(name);
    }
    return table;
  }

  const toml::node* node_at(const std::string& path, const std::string& name) const {
    const toml::table* table = table_at(path);
    return table == nullptr ? nullptr : table->get(name);
  }

  void declare(DeclaredKey key) {
    const bool is_known = std::any_of(declared.begin(), declared.end(), [&](const DeclaredKey& k) {
      return k.table == key.table && k.name == key.name;
    });
    if (!is_known) declared.push_back(std::move(key));
  }

  void declare_table(const std::string& path) {
    if (std::find(tables.begin(), tables.end(), path) == tables.end()) tables.push_back(path);
  }

  [[noreturn]] void reject(const toml::node* node, const std::string& key_path,
                           const std::string& what) const {
    std::string place = source;
    if (node != nullptr && node->source().begin.line > 0) {
      place += ":" + std::to_string(node->source().begin.line);
    }
    throw ConfigurationError(place + ": " + key_path + ": " + what);
  }

  /// The names that may stand in the table at `path`.
  std::vector<std::string> names_known_in(const std::string& path) const {
    std::vector<std::string> names;
    for (const DeclaredKey& key : declared) {
      if (key.table == path) names.push_back(key.name);
    }
    for (const std::string& table : tables) {
      const std::size_t dot = table.rfind('.');
      const std::string parent = dot == std::string::npos ? "" : table.substr(0, dot);
      if (parent == path) names.push_back(table.substr(dot == std::string::npos ? 0 : dot + 1));
    }
    return names;
  }

  /// The names that stand in the table at `path` and that nobody has asked for so far.
  std::vector<std::string> names_not_asked_for(const std::string& path) const {
    const std::vector<std::string> known = names_known_in(path);
    std::vector<std::string> names;
    const toml::table* table = table_at(path);
    if (table == nullptr) return names;
    for (const auto& [key, node] : *table) {
      const std::string name(key.str());
      if (std::find(known.begin(), known.end(), name) == known.end()) names.push_back(name);
    }
    return names;
  }

  void refuse_unknown(const toml::table& table, const std::string& path) const {
    const std::vector<std::string> known = names_known_in(path);
    for (const auto& [key, node] : table) {
      const std::string name(key.str());
      if (std::find(known.begin(), known.end(), name) == known.end()) {
        const std::string nearest = nearest_name(name, known);
        reject(&node, joined(path, name),
               std::string("unknown ") + (node.is_table() ? "table" : "key") +
                   (nearest.empty() ? "; remove it" : "; did you mean " + quoted(nearest) + "?"));
      }
      if (const toml::table* inner = node.as_table()) refuse_unknown(*inner, joined(path, name));
    }
  }

  /// The node, or none if the fallback holds. Throws if it is required and missing.
  const toml::node* find(const std::string& path, const std::string& name, bool has_fallback,
                         const std::string& what_is_expected) const {
    const toml::node* node = node_at(path, name);
    if (node == nullptr && !has_fallback && !is_reference) {
      const std::string nearest = nearest_name(name, names_not_asked_for(path));
      reject(table_at(path), joined(path, name),
             "missing; " + what_is_expected +
                 (nearest.empty() ? "" : "; is it misspelt as " + quoted(nearest) + "?"));
    }
    return node;
  }
};

CheckedTable::CheckedTable(std::shared_ptr<Document> document, std::string path)
    : document_(std::move(document)), path_(std::move(path)) {}

CheckedTable CheckedTable::read_file(const std::filesystem::path& file) {
  std::error_code error;
  if (std::filesystem::is_directory(file, error)) {
    throw ConfigurationError(file.string() + ": is a folder; give the TOML file itself");
  }
  std::ifstream stream(file, std::ios::binary);
  if (!stream) {
    throw ConfigurationError(file.string() + ": cannot be opened; check the path and its rights");
  }
  std::string text(kLargestFile + 1, '\0');
  stream.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(stream.gcount()));
  if (stream.bad()) throw ConfigurationError(file.string() + ": cannot be read");
  if (text.size() > kLargestFile) {
    throw ConfigurationError(file.string() + ": larger than 4 MiB; is it the right file?");
  }
  CheckedTable table = parse(text, file.string());
  table.document_->folder = file.parent_path();
  return table;
}

CheckedTable CheckedTable::parse(std::string_view text, const std::string& source) {
  auto document = std::make_shared<Document>();
  document->source = source;
  try {
    document->root = toml::parse(text, source);
  } catch (const toml::parse_error& error) {
    throw ConfigurationError(source + ":" + std::to_string(error.source().begin.line) + ":" +
                             std::to_string(error.source().begin.column) +
                             ": not valid TOML: " + std::string(error.description()));
  }
  return {std::move(document), ""};
}

CheckedTable CheckedTable::for_reference() {
  auto document = std::make_shared<Document>();
  document->source = "reference";
  document->is_reference = true;
  return {std::move(document), ""};
}

CheckedTable CheckedTable::table(const std::string& name) const {
  const toml::node* node = document_->node_at(path_, name);
  if (node != nullptr && !node->is_table()) {
    document_->reject(node, joined(path_, name), "expected a table, [" + joined(path_, name) + "]");
  }
  document_->declare_table(joined(path_, name));
  return {document_, joined(path_, name)};
}

std::vector<std::pair<std::string, CheckedTable>> CheckedTable::named_tables() const {
  std::vector<std::pair<std::string, CheckedTable>> tables;
  const toml::table* here = document_->table_at(path_);
  if (here == nullptr) return tables;
  for (const auto& [key, node] : *here) {
    const std::string name(key.str());
    // Paths are joined by dots; a dot in a name would make two of one.
    if (name.empty() || name.find('.') != std::string::npos) {
      document_->reject(&node, joined(path_, quoted(name)),
                        "a name must not be empty or have a dot");
    }
    tables.emplace_back(name, table(name));
  }
  return tables;
}

bool CheckedTable::has(const std::string& name) const {
  return document_->node_at(path_, name) != nullptr;
}

std::string CheckedTable::get(const TextKey& key) const {
  const std::string choices = choices_text(key.choices);
  document_->declare({path_, key.name, "text", key.fallback ? quoted(*key.fallback) : "", "",
                      choices, key.description});
  const std::string expectation = choices.empty() ? "expected a text" : "expected " + choices;
  const toml::node* node = document_->find(path_, key.name, key.fallback.has_value(), expectation);
  if (node == nullptr) return key.fallback.value_or("");

  const std::string where = joined(path_, key.name);
  if (!node->is_string()) document_->reject(node, where, expectation);
  const std::string& text = node->as_string()->get();
  if (!key.choices.empty() &&
      std::find(key.choices.begin(), key.choices.end(), text) == key.choices.end()) {
    document_->reject(node, where, quoted(text) + " is not possible; " + expectation);
  }
  if (text.empty() && !key.may_be_empty && key.choices.empty()) {
    document_->reject(node, where, "must not be empty");
  }
  return text;
}

bool CheckedTable::get(const FlagKey& key) const {
  document_->declare({path_, key.name, "flag",
                      key.fallback ? (*key.fallback ? "true" : "false") : "", "", "",
                      key.description});
  const toml::node* node =
      document_->find(path_, key.name, key.fallback.has_value(), "expected true or false");
  if (node == nullptr) return key.fallback.value_or(false);
  if (!node->is_boolean()) {
    document_->reject(node, joined(path_, key.name), "expected true or false");
  }
  return node->as_boolean()->get();
}

std::int64_t CheckedTable::get(const IntegerKey& key) const {
  const std::string range = range_text(key);
  document_->declare({path_, key.name, "integer", key.fallback ? std::to_string(*key.fallback) : "",
                      key.unit, range, key.description});
  const std::string expectation = expected("an integer", range, key.unit);
  const toml::node* node = document_->find(path_, key.name, key.fallback.has_value(), expectation);
  if (node == nullptr)
    return key.fallback.value_or(std::clamp<std::int64_t>(0, key.minimum, key.maximum));

  const std::string where = joined(path_, key.name);
  if (!node->is_integer()) document_->reject(node, where, expectation);
  const std::int64_t value = node->as_integer()->get();
  if (value < key.minimum || value > key.maximum) {
    document_->reject(node, where, std::to_string(value) + " is out of range; " + expectation);
  }
  return value;
}

double CheckedTable::get(const NumberKey& key) const {
  const std::string range = range_text(key.minimum, key.maximum);
  document_->declare({path_, key.name, "number", key.fallback ? as_toml(*key.fallback) : "",
                      key.unit, range, key.description});
  const std::string expectation = expected("a number", range, key.unit);
  const toml::node* node = document_->find(path_, key.name, key.fallback.has_value(), expectation);
  if (node == nullptr) return key.fallback.value_or(std::clamp(0.0, key.minimum, key.maximum));

  const std::string where = joined(path_, key.name);
  const std::optional<double> value = node->is_number() ? node->value<double>() : std::nullopt;
  if (!value || !std::isfinite(*value)) document_->reject(node, where, expectation);
  if (*value < key.minimum || *value > key.maximum) {
    document_->reject(node, where, shortest(*value) + " is out of range; " + expectation);
  }
  return *value;
}

std::vector<double> CheckedTable::get(const NumbersKey& key) const {
  const std::string range = range_text(key.minimum, key.maximum);
  document_->declare({path_, key.name, "numbers", key.fallback ? as_toml(*key.fallback) : "",
                      key.unit, range, key.description});
  const std::string kind =
      "an array of " + (key.count > 0 ? std::to_string(key.count) + " " : "") + "numbers";
  const std::string expectation = expected(kind, range, key.unit);
  const toml::node* node = document_->find(path_, key.name, key.fallback.has_value(), expectation);
  if (node == nullptr) {
    return key.fallback.value_or(
        std::vector<double>(key.count, std::clamp(0.0, key.minimum, key.maximum)));
  }

  const std::string where = joined(path_, key.name);
  const toml::array* array = node->as_array();
  if (array == nullptr || (key.count > 0 && array->size() != key.count)) {
    document_->reject(node, where, expectation);
  }
  std::vector<double> values;
  for (const toml::node& element : *array) {
    const std::optional<double> value =
        element.is_number() ? element.value<double>() : std::nullopt;
    if (!value || !std::isfinite(*value)) document_->reject(node, where, expectation);
    if (*value < key.minimum || *value > key.maximum) {
      document_->reject(node, where, shortest(*value) + " is out of range; " + expectation);
    }
    values.push_back(*value);
  }
  return values;
}

std::vector<std::string> CheckedTable::get(const TextsKey& key) const {
  const std::string expectation = "expected an array of texts";
  document_->declare({path_, key.name, "texts", key.fallback ? as_toml(*key.fallback) : "", "", "",
                      key.description});
  const toml::node* node = document_->find(path_, key.name, key.fallback.has_value(), expectation);
  if (node == nullptr) return key.fallback.value_or(std::vector<std::string>());

  const std::string where = joined(path_, key.name);
  const toml::array* array = node->as_array();
  if (array == nullptr) document_->reject(node, where, expectation);
  std::vector<std::string> texts;
  for (const toml::node& element : *array) {
    if (!element.is_string()) document_->reject(node, where, expectation);
    texts.push_back(element.as_string()->get());
  }
  return texts;
}

std::filesystem::path CheckedTable::resolve(const std::string& path) const {
  return (document_->folder / path).lexically_normal();
}

void CheckedTable::reject(const std::string& key, const std::string& what) const {
  const toml::node* node = document_->node_at(path_, key);
  document_->reject(node != nullptr ? node : document_->table_at(path_), joined(path_, key), what);
}

void CheckedTable::refuse_unknown_keys() const {
  document_->refuse_unknown(document_->root, "");
}

std::vector<DeclaredKey> CheckedTable::declared_keys() const {
  return document_->declared;
}

const std::string& CheckedTable::source() const {
  return document_->source;
}

}  // namespace biotomy::bridge
