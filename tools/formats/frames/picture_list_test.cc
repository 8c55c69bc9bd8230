#include "tools/formats/frames/picture_list.h"

#include <gmock/gmock.h>

namespace evit::formats {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

PictureFolder Folder(std::vector<std::string> names, bool stamped = false) {
  PictureFolder folder;
  folder.folder = "img", folder.name = "img", folder.stamped = stamped;
  for (const std::string& name : names) folder.pictures.push_back("img/" + name);
  return folder;
}

// "file@stamp" of each; "-": about other pictures.
std::vector<std::string> Read(const std::string& text, const PictureFolder& folder,
                              const std::string& list_folder = "img") {
  const auto listed = ReadPictureList({text, "the list", list_folder}, folder);
  if (!listed) return {"-"};
  std::vector<std::string> found;
  for (const ListedPicture& picture : *listed) found.push_back(picture.file + "@" + picture.stamp);
  return found;
}

TEST(PictureList, FindsNamesAndStampsWhateverTheOrderOfColumns) {
  const PictureFolder folder = Folder({"a.png", "b.png", "c.png"});
  const auto expected = ElementsAre("img/a.png@5.1", "img/b.png@5.2", "img/c.png@5.4");
  EXPECT_THAT(Read("5.1 a.png\n5.2 b.png\n5.4 c.png\n", folder), expected);
  EXPECT_THAT(Read("a.png 5.1\nb.png 5.2\nc.png 5.4\n", folder), expected);
  EXPECT_THAT(
      Read("# id timestamp image_name\n0 5.1 img/a.png\n1 5.2 img/b.png\n2 5.4 img/c.png\n", folder, ""),
      expected);
  EXPECT_THAT(Read("timestamp,name,exposure\n5.1,a.png,4\n5.2,b.png,4\n5.4,c.png,4\n", folder), expected);
  EXPECT_THAT(Read("5.1 rgb/a.png 5.1 img/a.png\n9.2 rgb/b.png 5.2 img/b.png\n9.4 rgb/c.png 5.4 img/c.png\n",
                   folder, ""),
              expected);
}

TEST(PictureList, TakesStampsThatCountWhereThereAreNoOthers) {
  EXPECT_THAT(Read("0 a.png\n1 b.png\n", Folder({"a.png", "b.png"})),
              ElementsAre("img/a.png@0", "img/b.png@1"));
}

// VECtor: begin and end of the exposure, and the begin is the picture's name.
TEST(PictureList, OfBeginAndEndOfExposureTheBeginCounts) {
  const std::string text =
      "# Left Regular Camera's timestamp data for desk\n# start and end of the exposure time[s] for each "
      "image\n"
      "1642661138.836530 1642661138.846530\n1642661138.869863 1642661138.879863\n";
  EXPECT_THAT(Read(text, Folder({"1642661138.836530.png", "1642661138.869863.png"}, true)),
              ElementsAre("img/1642661138.836530.png@1642661138.836530",
                          "img/1642661138.869863.png@1642661138.869863"));
  EXPECT_THAT(Read(text, Folder({"1.png", "2.png"})),
              ElementsAre("img/1.png@1642661138.836530", "img/2.png@1642661138.869863"));
  // Some pictures were removed, or renamed: their names say more than the list.
  EXPECT_THAT(Read(text, Folder({"1642661138.869863.png"}, true)),
              ElementsAre("img/1642661138.869863.png@1642661138.869863"));
  EXPECT_THAT(Read(text, Folder({"left1642661138.8.png"}, true)), ElementsAre("-"));
}

TEST(PictureList, KnowsPicturesByTheirNamesWithoutEndings) {
  EXPECT_THAT(Read("00000 1437144843.03 3.4\n00001 1437144843.07 3.5\n00002 1437144843.11 3.3\n",
                   Folder({"00000.jpg", "00002.jpg"})),
              ElementsAre("img/00000.jpg@1437144843.03", "img/00002.jpg@1437144843.11"));
  EXPECT_THAT(Read("left_a 0.1\nleft_b 0.3\n", Folder({"left_a.jpg", "left_b.jpg"})),
              ElementsAre("img/left_a.jpg@0.1", "img/left_b.jpg@0.3"));
}

TEST(PictureList, OneStampForEachPictureInTheOrderOfNames) {
  const PictureFolder folder = Folder({"9.png", "10.png"});
  EXPECT_THAT(Read("0.5\n0.7\n", folder), ElementsAre("img/9.png@0.5", "img/10.png@0.7"));
  EXPECT_THAT(Read("0 500\n1 700\n", folder), ElementsAre("img/9.png@500", "img/10.png@700"));
}

TEST(PictureList, PassesOverListsOfOtherPictures) {
  const PictureFolder folder = Folder({"a.png", "b.png"});
  EXPECT_THAT(Read("", folder), ElementsAre("-"));
  EXPECT_THAT(Read("1 depth/a.png\n2 depth/b.png\n", folder, ""), ElementsAre("-"));
  EXPECT_THAT(Read("1 2 3\n4 5 6\n7 8 9\n", folder, ""), ElementsAre("-"));
  EXPECT_THAT(Read("some words\nof text\n", folder, ""), ElementsAre("-"));
}

TEST(PictureList, SaysWhatIsWrongWithTheListBesideThePictures) {
  const auto error = [](const std::string& text) -> std::string {
    try {
      Read(text, Folder({"a.png", "b.png"}));
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_THAT(error("0.5\n"), HasSubstr("1 rows hold a stamp and no name, but there are 2 pictures"));
  EXPECT_THAT(error("0.5 a.png\nlate b.png\n"), HasSubstr("no column holds a stamp in each row"));
}

}  // namespace
}  // namespace evit::formats
