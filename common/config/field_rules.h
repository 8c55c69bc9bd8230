#pragma once

#include <string>

#include "common/config/setting.h"

namespace google::protobuf {
class Descriptor;
class EnumDescriptor;
class FieldDescriptor;
}  // namespace google::protobuf

namespace evit {

/// The shortest text that reads back as the same number.
std::string NumberText(double value);

/// The values a field may have, with its unit: "2 to 50 keyframes", "above 0 ms", "HUBER, CAUCHY or
/// GEMAN_MCCLURE". Empty where nothing is excluded.
std::string AllowedText(const google::protobuf::FieldDescriptor* field);

/// An enum's names: "HUBER, CAUCHY or GEMAN_MCCLURE".
std::string NamesText(const google::protobuf::EnumDescriptor* type);

/// Throws ConfigError where the value is outside of what its schema allows, or is not finite.
void CheckAllowed(const Setting& setting);

/// The field at "evit.window.size", below the schema's root; null where there is none.
const google::protobuf::FieldDescriptor* FindField(const google::protobuf::Descriptor* root,
                                                   const std::string& path);

}  // namespace evit
