#include "common/config/text_file.h"

#include <google/protobuf/descriptor.h>
#include <google/protobuf/io/tokenizer.h>
#include <google/protobuf/message.h>
#include <google/protobuf/text_format.h>

#include <filesystem>
#include <fstream>
#include <optional>

#include "common/config/config_error.h"
#include "common/config/field_rules.h"
#include "common/config/parse_error.h"

namespace evit {
namespace {

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;
using google::protobuf::TextFormat;

constexpr std::uintmax_t kLongest = 1 << 20;  // bytes; a longer file is something else

std::string ReadFile(const std::string& path) {
  std::error_code error;
  std::ifstream file(path, std::ios::binary);
  if (!file || !std::filesystem::is_regular_file(path, error)) {
    throw ConfigError(path + ": cannot be read; give the path of a text protobuf file");
  }
  if (std::filesystem::file_size(path, error) > kLongest) {
    throw ConfigError(path + ": is larger than 1 MB; give the path of a text protobuf file");
  }
  return {std::istreambuf_iterator<char>(file), {}};
}

class FirstError : public google::protobuf::io::ErrorCollector {
 public:
  void AddError(int line, int column, const std::string& words) override {
    if (!fault_) fault_ = {line, column, words};
  }
  const std::optional<ParseFault>& fault() const { return fault_; }

 private:
  std::optional<ParseFault> fault_;
};

// `k`: the element of a repeated field.
SettingValue ValueOf(const Message& m, const FieldDescriptor* f, int k) {
  const auto* r = m.GetReflection();
  const bool one = !f->is_repeated();
  switch (f->cpp_type()) {
    case FieldDescriptor::CPPTYPE_BOOL:
      return one ? r->GetBool(m, f) : r->GetRepeatedBool(m, f, k);
    case FieldDescriptor::CPPTYPE_INT32:
      return std::int64_t{one ? r->GetInt32(m, f) : r->GetRepeatedInt32(m, f, k)};
    case FieldDescriptor::CPPTYPE_INT64:
      return std::int64_t{one ? r->GetInt64(m, f) : r->GetRepeatedInt64(m, f, k)};
    case FieldDescriptor::CPPTYPE_ENUM:
      return std::int64_t{one ? r->GetEnumValue(m, f) : r->GetRepeatedEnumValue(m, f, k)};
    case FieldDescriptor::CPPTYPE_DOUBLE:
      return one ? r->GetDouble(m, f) : r->GetRepeatedDouble(m, f, k);
    case FieldDescriptor::CPPTYPE_STRING:
      return one ? r->GetString(m, f) : r->GetRepeatedString(m, f, k);
    default:
      return {};
  }
}

void Flatten(const std::string& file, const std::string& parent, const Message& message,
             TextFormat::ParseInfoTree* places, std::vector<Setting>* out) {
  std::vector<const FieldDescriptor*> fields;
  const auto* reflection = message.GetReflection();
  reflection->ListFields(message, &fields);
  for (const FieldDescriptor* field : fields) {
    const int n = field->is_repeated() ? reflection->FieldSize(message, field) : 1;
    int line = -1;
    for (int k = 0; k < n; ++k) {
      const int index = field->is_repeated() ? k : -1;
      const std::string path = parent + field->name();
      // Of a list in brackets, the parser knows the first number's line alone.
      if (const int found = places->GetLocation(field, index).line; found >= 0) line = found;
      out->push_back({path, ValueOf(message, field, k), field, file, line + 1});
      if (field->cpp_type() != FieldDescriptor::CPPTYPE_MESSAGE) continue;
      const Message& part = field->is_repeated() ? reflection->GetRepeatedMessage(message, field, k)
                                                 : reflection->GetMessage(message, field);
      Flatten(file, path + ".", part, places->GetTreeForNested(field, index), out);
    }
  }
}

}  // namespace

std::vector<Setting> ParsePartialTextFile(const std::string& path, Message* message) {
  const std::string text = ReadFile(path);
  FirstError errors;
  TextFormat::ParseInfoTree places;
  TextFormat::Parser parser;
  parser.RecordErrorsTo(&errors);
  parser.WriteLocationsTo(&places);
  parser.AllowPartialMessage(true);  // missing keys are the caller's affair
  if (!parser.ParseFromString(text, message)) {
    const ParseFault fault = errors.fault().value_or(ParseFault{0, 0, "cannot be read"});
    throw ConfigError(path + ":" + Explain(message->GetDescriptor(), text, fault));
  }
  std::vector<Setting> settings;
  Flatten(path, "", *message, &places, &settings);
  for (const Setting& setting : settings) CheckAllowed(setting);
  return settings;
}

std::vector<Setting> ParseTextFile(const std::string& path, Message* message) {
  std::vector<Setting> settings = ParsePartialTextFile(path, message);
  if (!message->IsInitialized()) {
    throw ConfigError(path + ": missing: " + message->InitializationErrorString() +
                      "; every one of these keys must be there, see the commented files in config/");
  }
  return settings;
}

}  // namespace evit
