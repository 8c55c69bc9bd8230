#include "common/config/text_file.h"

#include <google/protobuf/io/tokenizer.h>
#include <google/protobuf/message.h>
#include <google/protobuf/text_format.h>

#include <fstream>
#include <sstream>

#include "common/config/config.h"

namespace evit {
namespace {

// Keeps the first complaint of the parser, with its place.
class FirstError : public google::protobuf::io::ErrorCollector {
 public:
  void AddError(int line, int column, const std::string& message) override {
    if (!text_.empty()) return;
    text_ = std::to_string(line + 1) + ":" + std::to_string(column + 1) + ": " + message;
  }
  const std::string& text() const { return text_; }

 private:
  std::string text_;
};

}  // namespace

void ParseTextFile(const std::string& path, const std::string& schema, google::protobuf::Message* message) {
  std::ifstream file(path);
  if (!file) throw ConfigError(path + ": cannot be read; give the path of a text protobuf file");
  std::stringstream text;
  text << file.rdbuf();
  FirstError errors;
  google::protobuf::TextFormat::Parser parser;
  parser.RecordErrorsTo(&errors);
  parser.AllowPartialMessage(true);  // missing keys are named below, all at once
  if (!parser.ParseFromString(text.str(), message)) {
    throw ConfigError(path + ":" + errors.text() + "; known keys and their units are in " + schema);
  }
  if (!message->IsInitialized()) {
    throw ConfigError(path + ": missing: " + message->InitializationErrorString() +
                      "; every key must be there, see the commented files in config/");
  }
}

}  // namespace evit
