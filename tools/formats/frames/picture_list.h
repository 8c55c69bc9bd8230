#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace evit::formats {

bool IsPicture(const std::string& name);

/// A picture and when it was taken, as a list says.
struct ListedPicture {
  std::string file;   // in the tree
  std::string stamp;  // decimal text of whatever unit
};

/// A text file that may say when pictures were taken.
struct PictureList {
  std::string_view text;
  std::string path;    // for messages
  std::string folder;  // it lies in, in the tree
};

/// The pictures of one folder.
struct PictureFolder {
  std::vector<std::string> pictures;  // in the tree, in natural order
  std::string folder;                 // in the tree
  std::string name;                   // of the folder, as other tools would call it
  bool stamped = false;               // the pictures' names hold stamps of their own
};

/// Reads a list, whatever order its columns have: "stamp name" (TUM, RPG), "id stamp name" (UZH),
/// "stamp,name" (EuRoC), "id stamp exposure" where ids are names without their endings (TUM's monocular
/// data), or a row for each picture with its stamp, or begin and end of its exposure (VECtor's timestamp.txt;
/// the begin counts). Nothing where it is about other pictures. Throws std::runtime_error naming file, line
/// and remedy.
std::optional<std::vector<ListedPicture>> ReadPictureList(const PictureList& list,
                                                          const PictureFolder& pictures);

}  // namespace evit::formats
