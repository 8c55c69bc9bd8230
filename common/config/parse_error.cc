#include "common/config/parse_error.h"

#include <google/protobuf/descriptor.h>
#include <google/protobuf/descriptor.pb.h>
#include <google/protobuf/io/tokenizer.h>
#include <google/protobuf/io/zero_copy_stream_impl_lite.h>

#include <algorithm>
#include <regex>
#include <vector>

#include "common/config/field_rules.h"
#include "common/text/edit_distance.h"

namespace evit {
namespace {

using google::protobuf::Descriptor;
using google::protobuf::FieldDescriptor;
using google::protobuf::io::Tokenizer;

struct Key {
  std::string parent, name;
  int line, column;
  std::string path() const { return parent.empty() ? name : parent + "." + name; }
};

class Silent : public google::protobuf::io::ErrorCollector {
  void AddError(int, int, const std::string&) override {}
};

// The keys before the fault, as far as the text can be read.
std::vector<Key> KeysBefore(const std::string& text, const ParseFault& fault) {
  google::protobuf::io::ArrayInputStream stream(text.data(), static_cast<int>(text.size()));
  Silent silent;
  Tokenizer tokens(&stream, &silent);
  tokens.set_comment_style(Tokenizer::SH_COMMENT_STYLE);
  std::vector<Key> keys;
  std::vector<std::string> groups{""};
  Tokenizer::Token word;  // the last identifier, as long as it may become a key
  while (tokens.Next()) {
    const Tokenizer::Token& token = tokens.current();
    const bool opens = token.text == "{" || token.text == "<";
    if (token.type == Tokenizer::TYPE_IDENTIFIER) {
      word = token;
      continue;
    }
    if (!word.text.empty() && (opens || token.text == ":")) {
      if (std::pair(word.line, word.column) > std::pair(fault.line, fault.column)) break;
      keys.push_back({groups.back(), word.text, word.line, word.column});
    }
    word.text.clear();
    if (opens && !keys.empty()) groups.push_back(keys.back().path());
    if ((token.text == "}" || token.text == ">") && groups.size() > 1) groups.pop_back();
  }
  return keys;
}

// The key that is nearest to `key` in all of the schema; near ones beside it come first. `best`: how far it
// is.
void FindNearest(const Descriptor* type, const std::string& parent, const Key& key, std::size_t* best,
                 std::string* path) {
  for (int k = 0; k < type->field_count(); ++k) {
    const FieldDescriptor* field = type->field(k);
    if (field->options().deprecated()) continue;
    const std::string here = parent.empty() ? field->name() : parent + "." + field->name();
    const std::size_t distance = 2 * EditDistance(field->name(), key.name) + (parent == key.parent ? 0 : 1);
    if (distance < *best) {
      *best = distance;
      *path = here;
    }
    if (field->message_type() != nullptr) FindNearest(field->message_type(), here, key, best, path);
  }
}

std::string KnownKeys(const Descriptor* type) {
  std::string text;
  for (int k = 0; k < type->field_count(); ++k) {
    if (!type->field(k)->options().deprecated())
      text.append(text.empty() ? "" : ", ").append(type->field(k)->name());
  }
  return text;
}

std::string ExplainUnknown(const Descriptor* root, const Key& key) {
  const FieldDescriptor* group = key.parent.empty() ? nullptr : FindField(root, key.parent);
  const Descriptor* type = group == nullptr ? root : group->message_type();
  if (type == nullptr) return "no such key";
  std::size_t best = 2 * std::max<std::size_t>(1, key.name.size() / 3) + 2;
  std::string near;
  FindNearest(root, "", key, &best, &near);
  return "no such key; " + (near.empty() ? "" : "did you mean " + near + "? ") +
         (near.empty() ? "known" : "Known") +
         (key.parent.empty() ? std::string(" here") : " in " + key.parent) + ": " + KnownKeys(type);
}

std::string ExplainValue(const FieldDescriptor* field, std::string words) {
  static const std::regex kOther("specified along with field \"([^\"]*)\"");
  std::smatch match;
  if (std::regex_search(words, match, kOther))
    return "cannot be there beside " + match.str(1) + "; keep one of them";
  if (words.find("specified multiple times") != std::string::npos) return "is there twice; keep one";
  if (words.find("got: ") + 5 == words.size()) return "the file ends here, and a } is missing";
  while (!words.empty() && words.back() == '.') words.pop_back();
  const std::string allowed = field == nullptr ? "" : AllowedText(field);
  return allowed.empty() ? words : words + "; allowed: " + allowed;
}

}  // namespace

std::string Explain(const Descriptor* root, const std::string& text, const ParseFault& fault) {
  static const std::regex kUnknown("has no field named \"([^\"]*)\""), kNamed("[Ff]ield \"([^\"]*)\"");
  std::smatch match;
  const bool unknown = std::regex_search(fault.words, match, kUnknown);
  const bool named = unknown || std::regex_search(fault.words, match, kNamed);
  const std::vector<Key> keys = KeysBefore(text, fault);
  // The parser may be one word further on than the key it complains about.
  auto key = keys.rbegin();
  if (named) key = std::find_if(key, keys.rend(), [&](const Key& k) { return k.name == match.str(1); });
  if (key == keys.rend()) {
    return std::to_string(fault.line + 1) + ":" + std::to_string(fault.column + 1) + ": " + fault.words;
  }
  return std::to_string(key->line + 1) + ":" + std::to_string(key->column + 1) + ": " + key->path() + ": " +
         (unknown ? ExplainUnknown(root, *key) : ExplainValue(FindField(root, key->path()), fault.words));
}

}  // namespace evit
