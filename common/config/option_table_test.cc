// The option structs and the schema say the same: nothing is in one alone.
#include "common/config/option_table.h"

#include <gmock/gmock.h>
#include <google/protobuf/descriptor.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <type_traits>
#include <utility>

#include "common/config/field_options.pb.h"
#include "common/config/settings.pb.h"

namespace evit {
namespace {

using google::protobuf::Descriptor;
using google::protobuf::FieldDescriptor;

struct Anything {
  template <typename T>
  operator T() const;  // NOLINT: never called, only converts in CountMembers' question
};

template <typename Struct, typename Indices, typename = void>
struct IsInitializable : std::false_type {};
template <typename Struct, std::size_t... K>
struct IsInitializable<Struct, std::index_sequence<K...>,
                       std::void_t<decltype(Struct{(static_cast<void>(K), Anything{})...})>>
    : std::true_type {};

// How many members a struct without constructors has: the longest list of values that initialises it.
template <typename Struct, std::size_t N = 0>
constexpr std::size_t CountMembers() {
  if constexpr (IsInitializable<Struct, std::make_index_sequence<N + 1>>::value)
    return CountMembers<Struct, N + 1>();
  else
    return N;
}

template <typename Struct>
void ExpectAllInTable(const PipelineOptions& options, const Struct& part, const char* name) {
  std::set<const void*> found;
  const auto* begin = reinterpret_cast<const char*>(&part);
  for (const void* address : OptionAddresses(options)) {
    const auto* at = static_cast<const char*>(address);
    if (at >= begin && at < begin + sizeof part) found.insert(address);
  }
  EXPECT_EQ(found.size(), CountMembers<Struct>()) << "a member of " << name << " is not in the table";
}

TEST(OptionTable, HasEveryMemberOfEveryStruct) {
  const PipelineOptions o;
  ExpectAllInTable(o, o.keyframes, "KeyframeOptions");
  ExpectAllInTable(o, o.surface, "SurfaceOptions");
  ExpectAllInTable(o, o.points, "PointOptions");
  ExpectAllInTable(o, o.window, "WindowOptions");
  ExpectAllInTable(o, o.bootstrap, "BootstrapOptions");
  ExpectAllInTable(o, o.failure, "FailureOptions");
  ExpectAllInTable(o, o.photometric, "PhotometricOptions");
  EXPECT_EQ(CountMembers<PipelineOptions>(), 8U) << "method and the structs above";
}

void AppendLeaves(const Descriptor* type, const std::string& parent, std::vector<std::string>* paths) {
  for (int k = 0; k < type->field_count(); ++k) {
    const FieldDescriptor* field = type->field(k);
    if (field->options().deprecated()) continue;
    if (field->message_type() != nullptr) {
      AppendLeaves(field->message_type(), parent + field->name() + ".", paths);
    } else if (field->name() != "base") {
      paths->push_back(parent + field->name());
    }
  }
}

TEST(OptionTable, HasTheSchemasKeys) {
  std::vector<std::string> schema;
  AppendLeaves(config::Settings::descriptor(), "", &schema);
  EXPECT_THAT(OptionPaths(), ::testing::UnorderedElementsAreArray(schema));
}

void ExpectMovedKeysExist(const Descriptor* type, const std::set<std::string>& known) {
  for (int k = 0; k < type->field_count(); ++k) {
    for (const std::string& path : type->field(k)->options().GetRepeatedExtension(config::moved_to)) {
      const bool group =
          std::any_of(known.begin(), known.end(), [&](const auto& p) { return p.rfind(path + ".", 0) == 0; });
      EXPECT_TRUE(group || known.count(path) == 1) << path;
    }
    if (type->field(k)->message_type() != nullptr)
      ExpectMovedKeysExist(type->field(k)->message_type(), known);
  }
}

TEST(OptionTable, MovedKeysHaveAPlaceToGo) {
  const auto paths = OptionPaths();
  ExpectMovedKeysExist(config::Settings::descriptor(), {paths.begin(), paths.end()});
}

TEST(OptionTable, ReadsBackWhatItSets) {
  PipelineOptions options;
  SetOption("evit.window.size", std::int64_t{9}, &options);
  EXPECT_EQ(options.window.size, 9);
  SetOption("alignment.kernel", std::int64_t{config::Alignment::GEMAN_MCCLURE}, &options);
  EXPECT_EQ(options.window.kernel, RobustKernel::Kind::kGemanMcClure);
  EXPECT_EQ(GetOption(options, "alignment.kernel"), SettingValue(std::int64_t{2}));
  EXPECT_THROW(GetOption(options, "window.size"), std::logic_error);
}

// The table relies on enums of both sides having the same numbers.
TEST(OptionTable, EnumsHaveTheSchemasNumbers) {
  EXPECT_EQ(static_cast<int>(SurfaceOptions::Kind::kSymmetric), config::Surface::SYMMETRIC);
  EXPECT_EQ(static_cast<int>(RobustKernel::Kind::kHuber), config::Alignment::HUBER);
  EXPECT_EQ(static_cast<int>(RobustKernel::Kind::kCauchy), config::Alignment::CAUCHY);
  EXPECT_EQ(static_cast<int>(RobustKernel::Kind::kGemanMcClure), config::Alignment::GEMAN_MCCLURE);
  EXPECT_EQ(static_cast<int>(WindowOptions::FirstNode::kPrior), config::Window::PRIOR);
  EXPECT_EQ(static_cast<int>(WindowOptions::MotionModel::kImu), config::Evit::IMU);
  EXPECT_EQ(static_cast<int>(WindowOptions::MotionModel::kConstantVelocity), config::Evt::CONSTANT_VELOCITY);
}

}  // namespace
}  // namespace evit
