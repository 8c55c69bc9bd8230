#include "common/config/settings_text.h"

#include <google/protobuf/descriptor.h>

#include <algorithm>
#include <vector>

#include "common/config/field_options.pb.h"
#include "common/config/field_rules.h"
#include "common/config/option_table.h"
#include "common/config/settings.pb.h"

namespace evit {
namespace {

using google::protobuf::Descriptor;
using google::protobuf::FieldDescriptor;

constexpr std::size_t kCommentColumn = 34;

std::string ValueText(const FieldDescriptor* field, const SettingValue& value) {
  if (const auto* flag = std::get_if<bool>(&value)) return *flag ? "true" : "false";
  if (const auto* real = std::get_if<double>(&value)) return NumberText(*real);
  const std::int64_t whole = std::get<std::int64_t>(value);
  if (field->cpp_type() != FieldDescriptor::CPPTYPE_ENUM) return std::to_string(whole);
  return field->enum_type()->FindValueByNumber(static_cast<int>(whole))->name();
}

// What each of an enum's values means, one text a value that says it.
std::vector<std::string> Meanings(const FieldDescriptor* field) {
  std::vector<std::string> texts;
  for (int k = 0; field->enum_type() != nullptr && k < field->enum_type()->value_count(); ++k) {
    const auto* value = field->enum_type()->value(k);
    if (value->options().HasExtension(config::meaning))
      texts.push_back(value->name() + ": " + value->options().GetExtension(config::meaning));
  }
  return texts;
}

// What a value may be, or at least its unit.
std::string RangeAndUnit(const FieldDescriptor* field) {
  if (field->cpp_type() == FieldDescriptor::CPPTYPE_BOOL) return "";
  const std::string allowed = AllowedText(field);
  return allowed.empty() ? field->options().GetExtension(config::unit) : allowed;
}

// Prints the groups of a settings file.
class Printer {
 public:
  Printer(const PipelineOptions& options, const LoadedSettings* loaded, ShowKind kind)
      : options_(options), defaults_(DefaultsOf(options.method)), loaded_(loaded), kind_(kind) {}

  std::string Group(const Descriptor* type, const std::string& parent, const std::string& indent) const {
    std::string text;
    for (int k = 0; k < type->field_count(); ++k) {
      const FieldDescriptor* field = type->field(k);
      const std::string path = parent + field->name();
      if (field->options().deprecated() || path == "base") continue;
      const bool other_method = field->real_containing_oneof() != nullptr && !IsChosen(field);
      if (other_method) continue;
      text += field->message_type() == nullptr ? Line(field, path, indent) : Nested(field, path, indent);
    }
    return text;
  }

 private:
  // Its place among the methods is its number.
  bool IsChosen(const FieldDescriptor* method) const {
    return method->index_in_oneof() == static_cast<int>(options_.method);
  }

  std::string Nested(const FieldDescriptor* field, const std::string& path, const std::string& indent) const {
    const std::string inner = Group(field->message_type(), path + ".", indent + "  ");
    const bool method = field->real_containing_oneof() != nullptr;
    if (!inner.empty()) return indent + field->name() + " {\n" + inner + indent + "}\n";
    // The method is said even where nothing of it differs.
    return method ? indent + field->name() + " { }\n" : "";
  }

  std::string Line(const FieldDescriptor* field, const std::string& path, const std::string& indent) const {
    const SettingValue value = GetOption(options_, path), usual = GetOption(defaults_, path);
    if (kind_ == ShowKind::kChanges && value == usual) return "";
    std::string line = indent + field->name() + ": " + ValueText(field, value);
    if (loaded_ == nullptr) return line + "\n";
    line.resize(std::max(kCommentColumn, line.size() + 2), ' ');
    const std::string range = RangeAndUnit(field), help = field->options().GetExtension(config::help);
    line += "# " + range + (range.empty() || help.empty() ? "" : ": ") + help;
    const auto set = loaded_->set.find(path);
    line += set == loaded_->set.end()
                ? " [default]"
                : " [" + set->second.Place() + "; default " + ValueText(field, usual) + "]";
    std::string above;
    for (const std::string& meaning : Meanings(field)) above += indent + "# " + meaning + "\n";
    return above + line + "\n";
  }

  PipelineOptions options_, defaults_;
  const LoadedSettings* loaded_;  // null: without comments
  ShowKind kind_;
};

// A cell of a table.
std::string Cell(std::string text) {
  for (std::size_t at = 0; (at = text.find('|', at)) != std::string::npos; at += 2)
    text.replace(at, 1, "\\|");
  return text;
}

void AppendTable(const Descriptor* type, const std::string& parent, const PipelineOptions& defaults,
                 std::string* out) {
  std::string rows;
  for (int k = 0; k < type->field_count(); ++k) {
    const FieldDescriptor* field = type->field(k);
    if (field->message_type() != nullptr || field->options().deprecated() || parent.empty()) continue;
    const std::string path = parent + "." + field->name();
    std::string help = field->options().GetExtension(config::help);
    for (const std::string& meaning : Meanings(field)) help += ". " + meaning;
    rows += "| `" + field->name() + "` | `" + ValueText(field, GetOption(defaults, path)) + "` | " +
            Cell(RangeAndUnit(field)) + " | " + Cell(help) + " |\n";
  }
  if (!rows.empty())
    *out += "\n### " + parent + "\n\n| key | default | allowed | meaning |\n|---|---|---|---|\n" + rows;
  for (int k = 0; k < type->field_count(); ++k) {
    const FieldDescriptor* field = type->field(k);
    if (field->message_type() == nullptr || field->options().deprecated()) continue;
    const bool method = field->real_containing_oneof() != nullptr;
    const auto options =
        method ? DefaultsOf(static_cast<PipelineOptions::Method>(field->index_in_oneof())) : defaults;
    AppendTable(field->message_type(), (parent.empty() ? "" : parent + ".") + field->name(), options, out);
  }
}

}  // namespace

std::string SettingsText(const PipelineOptions& options, ShowKind kind) {
  return Printer(options, nullptr, kind).Group(config::Settings::descriptor(), "", "");
}

std::string CommentedSettings(const LoadedSettings& settings, ShowKind kind) {
  return Printer(settings.options, &settings, kind).Group(config::Settings::descriptor(), "", "");
}

std::string SettingsMarkdown() {
  std::string text;
  AppendTable(config::Settings::descriptor(), "", PipelineOptions(), &text);
  return text.empty() ? text : text.substr(1);
}

}  // namespace evit
