#include "common/config/field_rules.h"

#include <google/protobuf/descriptor.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "common/config/config_error.h"
#include "common/config/field_options.pb.h"

namespace evit {
namespace {

using google::protobuf::FieldDescriptor;
using google::protobuf::FieldOptions;

bool InRange(double v, const FieldOptions& o) {
  return std::isfinite(v) && (!o.HasExtension(config::min) || v >= o.GetExtension(config::min)) &&
         (!o.HasExtension(config::above) || v > o.GetExtension(config::above)) &&
         (!o.HasExtension(config::max) || v <= o.GetExtension(config::max)) &&
         (!o.HasExtension(config::below) || v < o.GetExtension(config::below));
}

// Without the unit.
std::string RangeText(const FieldOptions& o) {
  const bool open = o.HasExtension(config::below);
  std::string upper;
  if (open) upper = NumberText(o.GetExtension(config::below));
  if (o.HasExtension(config::max)) upper = NumberText(o.GetExtension(config::max));
  if (o.HasExtension(config::min)) {
    const std::string lower = NumberText(o.GetExtension(config::min));
    return upper.empty() ? lower + " or more" : lower + (open ? " to below " : " to ") + upper;
  }
  if (o.HasExtension(config::above)) {
    const std::string lower = "above " + NumberText(o.GetExtension(config::above));
    return upper.empty() ? lower : lower + (open ? ", below " : ", up to ") + upper;
  }
  return upper.empty() ? "" : (open ? "below " : "up to ") + upper;
}

}  // namespace

std::string NumberText(double value) {
  const bool whole =
      std::abs(value) < 1e15 && value == std::trunc(value) && !(value == 0 && std::signbit(value));
  if (whole) return std::to_string(static_cast<std::int64_t>(value));
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, value).ptr};
}

std::string NamesText(const google::protobuf::EnumDescriptor* type) {
  std::string text;
  for (int k = 0; k < type->value_count(); ++k) {
    text += (k == 0 ? "" : k + 1 < type->value_count() ? ", " : " or ") + type->value(k)->name();
  }
  return text;
}

std::string AllowedText(const FieldDescriptor* field) {
  if (field->cpp_type() == FieldDescriptor::CPPTYPE_ENUM) return NamesText(field->enum_type());
  if (field->cpp_type() == FieldDescriptor::CPPTYPE_BOOL) return "true or false";
  const std::string range = RangeText(field->options());
  const std::string unit = field->options().GetExtension(config::unit);
  return range.empty() || unit.empty() ? range : range + " " + unit;
}

void CheckAllowed(const Setting& s) {
  double number = 0;
  if (const auto* whole = std::get_if<std::int64_t>(&s.value)) {
    if (s.field->cpp_type() == FieldDescriptor::CPPTYPE_ENUM) {
      if (s.field->enum_type()->FindValueByNumber(static_cast<int>(*whole)) != nullptr) return;
      throw ConfigError(s.Place() + ": " + s.path + ": " + std::to_string(*whole) + " is not known; use " +
                        AllowedText(s.field));
    }
    number = static_cast<double>(*whole);
  } else if (const auto* real = std::get_if<double>(&s.value)) {
    number = *real;
  } else {
    return;
  }
  if (InRange(number, s.field->options())) return;
  const std::string allowed = AllowedText(s.field);
  throw ConfigError(s.Place() + ": " + s.path + ": " + NumberText(number) +
                    " is out of range; allowed: " + (allowed.empty() ? "finite numbers" : allowed));
}

const FieldDescriptor* FindField(const google::protobuf::Descriptor* root, const std::string& path) {
  const FieldDescriptor* field = nullptr;
  for (std::size_t begin = 0; begin <= path.size();) {
    if (field != nullptr) root = field->message_type();
    if (root == nullptr) return nullptr;
    const std::size_t end = std::min(path.find('.', begin), path.size());
    field = root->FindFieldByName(path.substr(begin, end - begin));
    if (field == nullptr) return nullptr;
    begin = end + 1;
  }
  return field;
}

}  // namespace evit
