// flatten_glsl OUT.glsl IN.glsl DEPFILE FOLDER...: writes a GLSL header that includes no other file, for installation.
// Includes are replaced by the files, each once, which are searched in the folders. GLSL has no namespaces, so every
// name at global scope gets a prefix: tyndall_x, TyndallX, kTyndallX or TYNDALL_X, depending on its case. Names that
// already have one of these prefixes are unchanged.
#include <cctype>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

namespace {

struct Failure {
  std::string message;
};

bool is_word(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; }

std::vector<std::string> read_lines(const std::filesystem::path& path) {
  std::ifstream file(path);
  if (!file) throw Failure{path.string() + ": cannot be read"};
  std::vector<std::string> lines;
  for (std::string line; std::getline(file, line);) lines.push_back(line);
  return lines;
}

// Returns the text after `directive` if a line begins with it, and an empty text otherwise.
std::string_view argument_of(std::string_view line, std::string_view directive) {
  return line.starts_with(directive) ? line.substr(directive.size()) : std::string_view();
}

class Flattener {
 public:
  explicit Flattener(std::vector<std::filesystem::path> folders) : folders_(std::move(folders)) {}

  // Appends a file with everything that it includes.
  void add(const std::filesystem::path& path, bool root) {
    files_.push_back(path);
    std::vector<std::string> lines = read_lines(path);
    if (!root) remove_guard(lines);
    for (const std::string& line : lines) {
      const std::string_view quoted = argument_of(line, "#include \"");
      if (quoted.empty()) {
        text_ += line + "\n";
        continue;
      }
      const std::string name(quoted.substr(0, quoted.find('"')));
      if (included_.insert(name).second) add(find(name), false);
    }
  }

  [[nodiscard]] const std::string& text() const { return text_; }
  [[nodiscard]] const std::vector<std::filesystem::path>& files() const { return files_; }

 private:
  [[nodiscard]] std::filesystem::path find(const std::string& name) const {
    for (const std::filesystem::path& folder : folders_) {
      if (std::filesystem::exists(folder / name)) return folder / name;
    }
    throw Failure{name + ": not found in the folders"};
  }

  // Removes the include guard. Every file is included once.
  static void remove_guard(std::vector<std::string>& lines) {
    for (std::size_t i = 0; i + 1 < lines.size(); ++i) {
      const std::string_view guard = argument_of(lines[i], "#ifndef ");
      if (guard.empty()) continue;
      if (lines[i + 1] != "#define " + std::string(guard)) return;
      lines.erase(lines.begin() + static_cast<std::ptrdiff_t>(i), lines.begin() + static_cast<std::ptrdiff_t>(i) + 2);
      while (!lines.empty() && lines.back() != "#endif") lines.pop_back();
      if (!lines.empty()) lines.pop_back();
      return;
    }
  }

  std::vector<std::filesystem::path> folders_;
  std::vector<std::filesystem::path> files_ = {};
  std::set<std::string> included_ = {};
  std::string text_ = {};
};

// A word or a character of the code, or a comment or directive as a whole.
struct Token {
  enum class Kind { word, mark, space, comment, directive } kind;
  std::string_view text;
};

std::vector<Token> tokens_of(std::string_view text) {
  std::vector<Token> out;
  for (std::size_t at = 0; at < text.size();) {
    std::size_t end = at + 1;
    Token::Kind kind = Token::Kind::mark;
    if (text.substr(at).starts_with("//")) {
      end = text.find('\n', at);
      kind = Token::Kind::comment;
    } else if (text[at] == '#') {
      end = text.find('\n', at);
      kind = Token::Kind::directive;
    } else if (is_word(text[at])) {
      while (end < text.size() && is_word(text[end])) ++end;
      kind = Token::Kind::word;
    } else if (std::isspace(static_cast<unsigned char>(text[at])) != 0) {
      kind = Token::Kind::space;
    }
    out.push_back({kind, text.substr(at, end - at)});
    at = std::min(end, text.size());
  }
  return out;
}

// Returns the name that a declaration at global scope declares, given its words and marks up to `;` or `{`.
std::string_view name_declared(const std::vector<std::string_view>& words) {
  std::size_t depth = 0;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (words[i] == "struct" && i + 1 < words.size()) return words[i + 1];
    const bool ends = words[i] == "(" || words[i] == "=" || words[i] == "[";
    if (depth == 0 && ends && i > 0 && words[i - 1] != "layout" && !words[i - 1].empty() && is_word(words[i - 1][0])) {
      // `TABLE_LAYOUT(0) uniform sampler3D name`: the call of a macro in place of a layout is not the name.
      const bool first = i == 1;
      if (!first) return words[i - 1];
    }
    if (words[i] == "(") ++depth;
    if (words[i] == ")") --depth;
  }
  return !words.empty() && is_word(words.back()[0]) ? words.back() : std::string_view();
}

// Returns the names at global scope, and those of macros, whether they are defined here or by the file that includes
// the header.
std::set<std::string> global_names(const std::vector<Token>& tokens) {
  std::set<std::string> out;
  std::vector<std::string_view> declaration;
  std::size_t depth = 0;
  for (const Token& token : tokens) {
    if (token.kind == Token::Kind::directive) {
      std::string_view macro = argument_of(token.text, "#define ");
      if (macro.empty()) macro = argument_of(token.text, "#ifdef ");
      std::size_t end = 0;
      while (end < macro.size() && is_word(macro[end])) ++end;
      const std::string_view name = macro.substr(0, end);
      if (!name.empty() && !name.starts_with("__")) out.emplace(name);
    }
    if (token.kind != Token::Kind::word && token.kind != Token::Kind::mark) continue;
    if (token.text == "}") {
      --depth;
      declaration = {};
    } else if (depth > 0) {
      if (token.text == "{") ++depth;
    } else if (token.text == ";" || token.text == "{") {
      const std::string_view name = name_declared(declaration);
      if (!name.empty()) out.emplace(name);
      declaration = {};
      if (token.text == "{") ++depth;
    } else {
      declaration.push_back(token.text);
    }
  }
  return out;
}

std::string with_prefix(const std::string& name) {
  for (const std::string_view prefix : {"tyndall_", "Tyndall", "kTyndall", "TYNDALL_"}) {
    if (name.starts_with(prefix)) return name;
  }
  bool small = false;
  for (const char c : name) small = small || std::islower(static_cast<unsigned char>(c)) != 0;
  const auto upper = [](char c) { return std::isupper(static_cast<unsigned char>(c)) != 0; };
  if (!small) return "TYNDALL_" + name;
  if (upper(name[0])) return "Tyndall" + name;
  if (name.size() > 1 && name[0] == 'k' && upper(name[1])) return "kTyndall" + name.substr(1);
  return "tyndall_" + name;
}

// Replaces the names in a text; with `calls`, only those before a bracket, as comments write functions.
std::string renamed(std::string_view text, const std::map<std::string, std::string>& names, bool calls) {
  std::string out;
  for (std::size_t at = 0; at < text.size();) {
    std::size_t end = at + 1;
    if (is_word(text[at])) {
      while (end < text.size() && is_word(text[end])) ++end;
    }
    const std::string word(text.substr(at, end - at));
    const auto found = names.find(word);
    const bool member = at > 0 && text[at - 1] == '.';
    const bool replaced = found != names.end() && !member && (!calls || (end < text.size() && text[end] == '('));
    out += replaced ? found->second : word;
    at = end;
  }
  return out;
}

// Returns the code with its names replaced, apart from the members of structures.
std::string renamed_code(const std::vector<Token>& tokens, const std::map<std::string, std::string>& names) {
  std::string out;
  bool in_structure = false;
  std::string_view before;  // the last word or mark
  for (std::size_t i = 0; i < tokens.size(); ++i) {
    const Token& token = tokens[i];
    const bool is_code = token.kind == Token::Kind::word || token.kind == Token::Kind::mark;
    const std::string_view next = i + 1 < tokens.size() ? tokens[i + 1].text : std::string_view();
    if (token.text == "struct") in_structure = true;
    if (token.text == "}") in_structure = false;
    const bool declares_member = in_structure && (next == ";" || next == "," || next == "[");
    const bool is_member = token.kind == Token::Kind::word && (before == "." || declares_member);
    out += is_member ? std::string(token.text) : renamed(token.text, names, token.kind == Token::Kind::comment);
    if (is_code) before = token.text;
  }
  return out;
}

void write(const std::string& path, const std::string& text) {
  std::filesystem::create_directories(std::filesystem::path(path).parent_path());
  std::ofstream out(path, std::ios::binary);
  out << text;
  out.close();
  if (!out) throw Failure{path + ": cannot be written"};
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 5) {
    std::fprintf(stderr, "usage: flatten_glsl OUT.glsl IN.glsl DEPFILE FOLDER...\n");
    return 2;
  }
  try {
    Flattener flattener(std::vector<std::filesystem::path>(argv + 4, argv + argc));
    flattener.add(argv[2], true);
    const std::vector<Token> tokens = tokens_of(flattener.text());
    std::map<std::string, std::string> names;
    for (const std::string& name : global_names(tokens)) names[name] = with_prefix(name);
    write(argv[1], renamed_code(tokens, names));
    std::string depends = std::string(argv[1]) + ":";
    for (const std::filesystem::path& file : flattener.files()) depends += " \\\n  " + file.string();
    write(argv[3], depends + "\n");
  } catch (const Failure& failure) {
    std::fprintf(stderr, "flatten_glsl: error: %s\n", failure.message.c_str());
    return 1;
  }
  return 0;
}
