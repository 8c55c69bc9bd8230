#include "tools/formats/recognition/other_contents.h"

#include <algorithm>
#include <cctype>
#include <fstream>
#include <stdexcept>
#include <string_view>

#include "common/files/table_reader.h"
#include "common/files/table_sample.h"
#include "common/text/words.h"
#include "tools/formats/import/event_columns.h"
#include "tools/formats/ros2/bag_metadata.h"

namespace evit::formats {
namespace {

constexpr std::size_t kLooked = 512;  // bytes

struct Contents {
  std::size_t at;
  std::string_view begin;
  const char* what;
};

using std::string_view_literals::operator""sv;

constexpr char kCompressed[] = "is compressed; unpack it and import what comes out: ";
constexpr char kPicture[] = "is a picture; EVIT needs events, which pictures do not have";
constexpr char kVideo[] = "is a video; EVIT needs events, which frames do not have";

constexpr Contents kPacked[] = {
    {0, "\x1f\x8b"sv, "gunzip FILE"},
    {0, "BZh"sv, "bunzip2 FILE"},
    {0,
     "\xfd"
     "7zXZ"sv,
     "unxz FILE"},
    {0, "\x28\xb5\x2f\xfd"sv, "unzstd FILE"},
    {0, "\x04\x22\x4d\x18"sv, "unlz4 FILE"},
    {0, "7z\xbc\xaf"sv, "7z x FILE"},
    {0, "PK\x03\x04"sv, "unzip FILE"},
    {0, "Rar!"sv, "unrar x FILE"},
    {257, "ustar"sv, "tar xf FILE"},
};

constexpr Contents kOthers[] = {
    {0, "\x89PNG"sv, kPicture},
    {0, "\xff\xd8\xff"sv, kPicture},
    {0, "GIF8"sv, kPicture},
    {0, "II*\0"sv, kPicture},
    {4, "ftyp"sv, kVideo},
    {8, "AVI "sv, kVideo},
    {0, "\x1a\x45\xdf\xa3"sv, kVideo},
    {0, "%PDF"sv, "is a document (PDF)"},
    {0, "version https://git-lfs"sv,
     "is a pointer of Git LFS, not the file itself; fetch it with `git lfs pull`"},
    {0, "\xed\xa1\xda\x01"sv, "is an LCM log already: `evit run --log`"},
    {0, "# .PCD"sv, "is a map; give it to `evit run --map`"},
    {0, "VERSION .7"sv, "is a map; give it to `evit run --map`"},
    {0, "ply\n"sv, "is a map; give it to `evit run --map`"},
    {0, "\xff\xfe"sv, "is UTF-16 text; save it as UTF-8: iconv -f UTF-16 -t UTF-8 FILE"},
    {0, "\xfe\xff"sv, "is UTF-16 text; save it as UTF-8: iconv -f UTF-16 -t UTF-8 FILE"},
    {0, "MATLAB 5.0 MAT-file"sv,
     "is MATLAB's; save it in version 7.3 (HDF5) or as text: writematrix([t x y p], 'events.txt', "
     "'Delimiter', ' ')"},
};

bool Has(std::string_view text, const Contents& contents) {
  return text.size() >= contents.at + contents.begin.size() &&
         text.substr(contents.at, contents.begin.size()) == contents.begin;
}

// Which columns of five or six may be those of events, with all others left out.
std::string PossibleNames(const TableSample& sample) {
  const std::size_t n = sample.rows.front().size();
  for (unsigned others = 1U << n; others-- > 1;) {
    TableSample four;
    for (const auto& row : sample.rows) {
      four.rows.emplace_back();
      for (std::size_t k = 0; k < n && row.size() == n; ++k) {
        if ((others >> k & 1U) == 0) four.rows.back().push_back(row[k]);
      }
    }
    if (four.rows.front().size() != 4 || !FitsEvents(four)) continue;
    const EventColumns columns = FindEventColumns(std::move(four));
    constexpr const char* kNames[] = {"t", "x", "y", "p"};
    std::string names;
    for (std::size_t k = 0, event = 0; k < n; ++k) {
      const bool other = (others >> k & 1U) != 0;
      names += std::string(k > 0 ? " " : "") + (other ? "other" : kNames[columns.field[event]]);
      event += other ? 0 : 1;
    }
    return names;
  }
  return "";
}

std::string OfUnnamed(const TableSample& sample) {
  const std::string names = PossibleNames(sample), n = std::to_string(sample.rows.front().size());
  if (names.empty()) return "is a table of " + n + " columns, none of which can be those of events (t x y p)";
  return "is a table of " + n +
         " columns without names, which may be events: name them in a first line, if " +
         "they are these: sed '1i " + names + "' FILE > named.txt";
}

bool IsBinary(std::string_view text) {
  return std::any_of(text.begin(), text.end(), [](unsigned char c) { return c < '\t'; });
}

std::string OfText(const std::string& path, std::string_view text) {
  std::string begin(text.substr(0, 200));
  begin.erase(0, std::min(begin.size(), begin.find_first_not_of(" \t\r\n")));
  std::transform(begin.begin(), begin.end(), begin.begin(), [](unsigned char c) { return std::tolower(c); });
  if (begin.rfind("<!doctype", 0) == 0 || begin.rfind("<html", 0) == 0)
    return "is a web page, not what it was to be a download of; download it again";
  if (!begin.empty() && (begin[0] == '{' || begin[0] == '['))
    return "is JSON; a calibration is given with --calibration, events as lines: t x y p";
  if (IsBagMetadata(begin))
    return "lists the parts of a ROS 2 bag; give the folder that it is in, or the parts";
  try {
    const TableSample sample = SampleTable(path, "t x y p", 20);
    if (sample.rows.empty() && sample.head.empty())
      return "holds nothing but blanks and comments; copy or download it again";
    if (sample.rows.empty() && (NamesEvents(sample.head) || (!begin.empty() && IsDigit(begin[0]))))
      return "has no rows of numbers with blanks, tabs, commas or semicolons between them";
    const std::size_t columns = sample.rows.empty() ? 0 : sample.rows.front().size();
    double value = 0;
    if ((columns == 5 || columns == 6) && sample.head.empty() && ParseNumber(sample.rows.front()[0], &value))
      return OfUnnamed(sample);
    if (columns >= 7 && ParseNumber(sample.rows.front()[1], &value))
      return "is a table of " + std::to_string(columns) +
             " columns; an IMU's is given with --imu, one of poses with --truth, beside a file of events";
  } catch (const std::runtime_error& error) {
    const std::string what = error.what();
    if (text.find('\0') == std::string_view::npos && what.rfind(path + ":", 0) == 0)
      return what.substr(path.size() + 1);
  }
  return "";
}

}  // namespace

std::string OtherContents(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::string text(kLooked, '\0');
  file.read(text.data(), kLooked);
  text.resize(static_cast<std::size_t>(std::max<std::streamsize>(0, file.gcount())));
  if (text.empty()) return "is empty; copy or download it again";
  for (const Contents& contents : kPacked)
    if (Has(text, contents)) return kCompressed + std::string(contents.what);
  for (const Contents& contents : kOthers)
    if (Has(text, contents)) return contents.what;
  if (IsBinary(text)) {
    return "has no head of a format that is recognised; a later part of a file that was split is joined to "
           "the "
           "first one: cat PART... > FILE";
  }
  return OfText(path, text);
}

}  // namespace evit::formats
