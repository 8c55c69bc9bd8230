#include "common/bus/generator/message_code.h"

#include <algorithm>
#include <cctype>
#include <map>
#include <regex>
#include <set>
#include <stdexcept>
#include <utility>

#include "common/bus/wire_layout.h"

namespace evit::generator {
namespace {

const std::map<std::string, std::int64_t>& PrimitiveSizes() {
  static const std::map<std::string, std::int64_t> sizes{{"int8_t", 1},  {"byte", 1},    {"boolean", 1},
                                                         {"int16_t", 2}, {"int32_t", 4}, {"float", 4},
                                                         {"int64_t", 8}, {"double", 8}};
  return sizes;
}

[[noreturn]] void Fail(const MessageType& type, const Field& field, const std::string& what) {
  throw std::runtime_error(type.file + ":" + std::to_string(field.line) + ": " + field.name + " " + what);
}

const MessageType* Find(const std::vector<MessageType>& types, const std::string& name) {
  const auto found = std::find_if(types.begin(), types.end(), [&](const auto& t) { return t.name == name; });
  return found == types.end() ? nullptr : &*found;
}

std::vector<const MessageType*> Messages(const std::vector<MessageType>& types) {
  std::set<std::string> parts;
  for (const MessageType& type : types) {
    for (const Field& field : type.fields) parts.insert(field.type);
  }
  std::vector<const MessageType*> messages;
  for (const MessageType& type : types) {
    if (parts.count(type.name) == 0) messages.push_back(&type);
  }
  return messages;
}

bool IsCount(const MessageType& type, const Field& field) {
  for (const Field& other : type.fields) {
    for (const Dimension& d : other.dimensions) {
      if (d.count == field.name) return true;
    }
  }
  return false;
}

std::string Limit(const MessageType& type, const Field& field) {
  static const std::regex pattern(R"(at most (\d+))");
  std::smatch match;
  if (field.type != "int32_t") Fail(type, field, "counts an array: it has to be an int32_t");
  if (!std::regex_search(field.comment, match, pattern)) {
    Fail(type, field, "counts an array: its comment has to say \"at most NUMBER\"");
  }
  return match[1];
}

/// The array's counts, first to last; the product of its fixed dimensions in `fixed`.
std::vector<std::string> Counts(const MessageType& type, const Field& field, std::int64_t* fixed) {
  std::vector<std::string> counts;
  *fixed = 1;
  for (std::size_t i = 0; i < field.dimensions.size(); ++i) {
    const Dimension& d = field.dimensions[i];
    if (d.count.empty()) {
      *fixed *= d.size;
      continue;
    }
    if (counts.size() != i || i > 1)
      Fail(type, field, "may have counted dimensions only first, and two of them");
    counts.push_back(d.count);
  }
  return counts;
}

/// Writes the layout of one message, entry by entry.
class LayoutWriter {
 public:
  LayoutWriter(const std::vector<MessageType>& types, std::string message)
      : types_(types), message_(std::move(message)) {}

  void Write(const MessageType& type, const std::string& prefix = "") {
    for (const Field& field : type.fields) {
      std::int64_t fixed = 1;
      const std::vector<std::string> counts = Counts(type, field, &fixed);
      const std::string name = "\"" + prefix + field.name + "\"";
      const MessageType* const inner = Find(types_, field.type);
      if (IsCount(type, field)) {
        if (!prefix.empty()) Fail(type, field, "counts an array inside another type, which is not supported");
        if (++n_counts_ > kMaxCounts) Fail(type, field, "is one count too many for WireLayout");
        Entry("Count(" + name + ", " + Limit(type, field) + ")");
      } else if (field.type == "string") {
        if (fixed != 1 || counts.size() > 1) Fail(type, field, "may be one string or a counted list of them");
        Entry("Text(" + name + Quoted(counts) + ")");
      } else if (inner == nullptr) {
        const auto size = PrimitiveSizes().find(field.type);
        if (size == PrimitiveSizes().end()) Fail(type, field, "has the unknown type " + field.type);
        Elements(size->second * fixed, counts);
      } else if (field.dimensions.empty()) {
        Write(*inner, prefix + field.name + ".");
      } else {
        if (fixed != 1 || counts.size() != 1)
          Fail(type, field, "may be one " + field.type + " or a counted list");
        Group(*inner, prefix + field.name + ".", counts[0]);
      }
    }
  }
  /// "Bytes(24), Count(...), ..."
  std::string Finish() {
    Flush();
    return entries_;
  }
  /// Definitions that the entries refer to.
  const std::string& groups() const { return groups_; }

 private:
  static std::string Quoted(const std::vector<std::string>& counts) {
    std::string out;
    for (const std::string& count : counts) out += ", \"" + count + "\"";
    return out;
  }
  void Elements(std::int64_t bytes, const std::vector<std::string>& counts) {
    if (counts.empty()) {
      bytes_ += bytes;
    } else {
      Entry("Array(" + std::to_string(bytes) + Quoted(counts) + ")");
    }
  }
  void Group(const MessageType& inner, const std::string& prefix, const std::string& count) {
    LayoutWriter fields(types_, message_);
    fields.Write(inner, prefix);
    if (fields.entries_.empty()) {
      Elements(fields.bytes_, {count});
      return;
    }
    const std::string name = inner.name + "_of_" + message_;
    groups_ += "const WireLayout& " + name + "() {\n  static const WireLayout fields = {" + fields.Finish() +
               "};\n  return fields;\n}\n\n";
    Entry("Group(&" + name + "(), \"" + count + "\")");
  }
  void Entry(const std::string& entry) {
    Flush();
    entries_ += (entries_.empty() ? "" : ", ") + entry;
  }
  void Flush() {
    const std::int64_t bytes = bytes_;
    bytes_ = 0;
    if (bytes > 0) Entry("Bytes(" + std::to_string(bytes) + ")");
  }

  const std::vector<MessageType>& types_;
  std::string message_, entries_, groups_;
  std::size_t n_counts_ = 0;
  std::int64_t bytes_ = 0;  // fields of fixed size since the last entry
};

std::string VisitOf(const MessageType& type) {
  std::string body;
  for (const Field& field : type.fields) {
    std::int64_t fixed = 1;
    const std::vector<std::string> counts = Counts(type, field, &fixed);
    if (counts.empty()) continue;
    body += "  visit(\"" + field.name + "\", m." + counts[0] + ", m." + field.name + ");\n";
    if (field.dimensions.size() == 1) continue;
    if (field.dimensions.size() > 2) Fail(type, field, "has more than two dimensions");
    const std::string columns =
        counts.size() == 2 ? "m." + counts[1] : std::to_string(field.dimensions[1].size);
    body +=
        "  for (auto& row : m." + field.name + ") visit(\"" + field.name + "[i]\", " + columns + ", row);\n";
  }
  const bool used = !body.empty();
  return "template <typename Message, typename Visitor>\nvoid VisitArraysOf(const " + type.name +
         "* /*type*/, Message& " + (used ? "m" : "/*m*/") + ", const Visitor& " +
         (used ? "visit" : "/*visit*/") + ") {\n" + body + "}\n";
}

}  // namespace

std::string MessagesHeader(const std::vector<MessageType>& types) {
  const std::vector<const MessageType*> messages = Messages(types);
  const std::string package = types.at(0).package;
  std::string macro = package, includes, list, names, visits;
  std::transform(macro.begin(), macro.end(), macro.begin(), [](unsigned char c) { return std::toupper(c); });
  for (const MessageType* type : messages) {
    includes += "#include \"" + package + "/" + type->name + ".hpp\"\n";
    list += " \\\n  X(" + type->name + ")";
    names += (names.empty() ? "" : ", ") + type->name;
    visits += VisitOf(*type);
  }
  return "// Generated from lcmtypes/ by common/bus/generator.\n#pragma once\n\n" + includes + "\n#define " +
         macro + "_MESSAGES(X)" + list + "\n\nnamespace " + package +
         " {\n\ntemplate <template <typename...> class List>\nusing AllMessages = List<" + names + ">;\n\n" +
         visits + "\n}  // namespace " + package + "\n";
}

std::string LayoutsSource(const std::vector<MessageType>& types) {
  const std::string package = types.at(0).package;
  std::string groups, layouts;
  for (const MessageType* type : Messages(types)) {
    LayoutWriter writer(types, type->name);
    writer.Write(*type);
    const std::string entries = writer.Finish();
    groups += writer.groups();
    layouts += "template <>\nconst WireLayout& LayoutOf<" + package + "::" + type->name +
               ">() {\n  static const WireLayout layout = {" + entries + "};\n  return layout;\n}\n\n";
  }
  return "// Generated from lcmtypes/ by common/bus/generator.\n#include \"" + package +
         "/messages.hpp\"\n\n#include \"common/bus/wire_layout.h\"\n\nnamespace evit {\nnamespace {\n\n" +
         groups + "}  // namespace\n\n" + layouts + "}  // namespace evit\n";
}

}  // namespace evit::generator
