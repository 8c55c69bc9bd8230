#include "tools/formats/tables/table_kind.h"

#include <gtest/gtest.h>

#include "tests/helpers/temporary_folder.h"

namespace evit::formats {
namespace {

std::string Repeated(const std::string& rest) {
  std::string text;
  for (int k = 0; k < 20; ++k) text += "16000000" + std::to_string(10 + k) + ".5 " + rest + "\n";
  return text;
}

TEST(KindOfTable, IsToldByNamesAndValues) {
  const TemporaryFolder folder("table_kind");
  const std::pair<std::string, TableKind> cases[] = {
      {Repeated("12 34 1"), TableKind::kEvents},
      {"timestamp,x,y,polarity\n1,2,3,1\n2,3,4,0\n", TableKind::kEvents},
      {Repeated("0.1 0.2 0.3 0.1 0.2 9.8"), TableKind::kImu},
      {Repeated("0.1 0.2 9.8 0.1 0.2 0.3"), TableKind::kImu},
      {Repeated("0.1 0.2 0.3 0.1 0.2 9.8 36.5"), TableKind::kImu},            // a temperature
      {Repeated("0.1 0.2 0.3 0.1 0.2 9.8 0 0 0 1"), TableKind::kImu},         // VECtor's, with an orientation
      {"#t [ns],w_x,w_y,w_z,a_x,a_y,a_z\n1,0,0,0,0,0,0\n", TableKind::kImu},  // names say it
      {Repeated("1 2 3 0 0.6 0 0.8"), TableKind::kPoses},
      {Repeated("1 2 3 0 0.707 0 0.707 0.1 0.2"), TableKind::kPoses},
      {Repeated("images/frame_1.png"), TableKind::kNone},
      {Repeated("1 2 3 40 50 60 7"), TableKind::kNone},
      {"", TableKind::kNone},
      {std::string("\0\1\2\3", 4), TableKind::kNone}};
  for (const auto& [text, kind] : cases)
    EXPECT_EQ(KindOfTable(folder.Write("a.txt", text)), kind) << text.substr(0, 60);
  EXPECT_EQ(KindOfTable(folder.File("missing.txt")), TableKind::kNone);
}

}  // namespace
}  // namespace evit::formats
