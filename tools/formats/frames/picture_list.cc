#include "tools/formats/frames/picture_list.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>
#include <stdexcept>

#include "common/files/table_reader.h"
#include "common/text/words.h"

namespace evit::formats {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxColumns = 16;

// Columns of words; a short row has empty ones at its end.
struct Table {
  std::vector<std::vector<std::string>> rows;
  std::size_t columns = 0;
};

Table ReadTable(const PictureList& list) {
  TableReader reader(list.text, list.path, "stamp name");
  Table table;
  while (reader.Next()) {
    std::vector<std::string> row;
    while (reader.more() && row.size() < kMaxColumns) row.emplace_back(reader.Word());
    table.columns = std::max(table.columns, row.size());
    table.rows.push_back(std::move(row));
  }
  for (auto& row : table.rows) row.resize(table.columns);
  return table;
}

bool IsNumeric(const Table& table, std::size_t column) {
  double number = 0;
  return std::all_of(table.rows.begin(), table.rows.end(),
                     [&](const auto& row) { return ParseNumber(row[column], &number); });
}

// 0, 1, 2, ...: says which picture, not when.
bool Counts(const Table& table, std::size_t column) {
  double last = 0, number = 0;
  for (std::size_t k = 0; k < table.rows.size(); ++k) {
    if (!ParseNumber(table.rows[k][column], &number) || (k > 0 && number != last + 1)) return false;
    last = number;
  }
  return table.rows.size() > 1;
}

bool Ascends(const Table& table, std::size_t column) {
  double last = 0, number = 0;
  for (std::size_t k = 0; k < table.rows.size(); ++k) {
    if (!ParseNumber(table.rows[k][column], &number) || (k > 0 && number < last)) return false;
    last = number;
  }
  return true;
}

// The stamps' column: it increases, and by other steps than one. Nearest before the names, if there are such
// columns (of two pairs in a row, colour and depth, each has its own stamp before it), else the first.
std::optional<std::size_t> StampColumn(const Table& table, std::optional<std::size_t> names) {
  std::vector<std::size_t> order;
  for (std::size_t c = names.value_or(0); c-- > 0;) order.push_back(c);
  for (std::size_t c = names ? *names + 1 : 0; c < table.columns; ++c) order.push_back(c);
  std::optional<std::size_t> numeric;
  for (const std::size_t c : order) {
    if (!IsNumeric(table, c)) continue;
    if (Ascends(table, c) && !Counts(table, c)) return c;
    if (!numeric) numeric = c;
  }
  return numeric;
}

// Which picture a word of the list names; empty: none of these.
class Names {
 public:
  Names(const PictureList& list, const PictureFolder& pictures)
      : pictures_(pictures), beside_(list.folder == pictures.folder) {
    for (const std::string& picture : pictures.pictures) {
      known_.insert(picture);
      by_stem_.emplace(fs::path(picture).stem().string(), picture);
    }
  }

  // Names are given from the list's folder (TUM, RPG), or from the pictures'. Colour and depth often have
  // files of the same names.
  std::string Picture(const std::string& word) const {
    const fs::path name{word};
    const std::string in_folder = name.parent_path().filename().string();
    if (!beside_ && !in_folder.empty() && in_folder != pictures_.name) return "";
    const std::string file =
        (fs::path(pictures_.folder) / name.filename()).lexically_normal().generic_string();
    return known_.count(file) > 0 ? file : "";
  }
  std::string WithoutEnding(const std::string& word) const {
    const auto at = by_stem_.find(word);
    return at == by_stem_.end() ? "" : at->second;
  }

 private:
  const PictureFolder& pictures_;
  bool beside_;
  std::set<std::string> known_;
  std::map<std::string, std::string> by_stem_;
};

// The column in which pictures are named, most of these; nothing: none is.
std::optional<std::size_t> NameColumn(const Table& table, const Names& names) {
  std::optional<std::size_t> best;
  std::size_t most = 0;
  for (std::size_t c = 0; c < table.columns; ++c) {
    std::size_t like = 0, here = 0;
    for (const auto& row : table.rows) {
      if (!IsPicture(row[c])) continue;
      ++like;
      here += names.Picture(row[c]).empty() ? 0 : 1;
    }
    if (like == 0) continue;
    if (!best || here > most) best = c, most = here;
  }
  return best;
}

// By names without endings. They may be the stamps themselves; VECtor's lists begin with these.
std::optional<std::vector<ListedPicture>> ByStems(const Table& table, const Names& names,
                                                  std::size_t pictures) {
  for (std::size_t c = 0; c < table.columns; ++c) {
    const auto stamps = IsNumeric(table, c) && !Counts(table, c) ? c : StampColumn(table, c);
    if (!stamps) continue;
    std::vector<ListedPicture> found;
    for (const auto& row : table.rows) {
      const std::string picture = names.WithoutEnding(row[c]);
      if (!picture.empty()) found.push_back({picture, row[*stamps]});
    }
    if (2 * found.size() >= pictures) return found;
  }
  return std::nullopt;
}

}  // namespace

bool IsPicture(const std::string& name) {
  const std::string lower = LowerCase(name);
  for (const char* end : {".png", ".jpg", ".jpeg", ".bmp", ".tif", ".tiff", ".pgm"}) {
    if (EndsWith(lower, end)) return true;
  }
  return false;
}

std::optional<std::vector<ListedPicture>> ReadPictureList(const PictureList& list,
                                                          const PictureFolder& pictures) {
  const Table table = ReadTable(list);
  if (table.rows.empty()) return std::nullopt;
  const Names names(list, pictures);
  const auto name_column = NameColumn(table, names);
  const auto stamp_column = StampColumn(table, name_column);
  const bool beside = list.folder == pictures.folder;
  if (!name_column) {
    if (auto found = ByStems(table, names, pictures.pictures.size())) return found;
  }
  if (!stamp_column) {
    if (!beside) return std::nullopt;
    throw std::runtime_error(list.path + ": no column holds a stamp in each row (the first is \"" +
                             table.rows.front().front() + "\"); expected \"stamp name\" in a row");
  }
  std::vector<ListedPicture> found;
  if (name_column) {
    std::size_t elsewhere = 0;
    for (const auto& row : table.rows) {
      const std::string picture = names.Picture(row[*name_column]);
      if (picture.empty()) {
        ++elsewhere;
      } else {
        found.push_back({picture, row[*stamp_column]});
      }
    }
    if (found.empty() || found.size() < elsewhere) return std::nullopt;
    return found;
  }
  if (table.rows.size() != pictures.pictures.size()) {
    // Of another sensor, if it lies above; of pictures that were since removed, if their names tell more.
    if (!beside || pictures.stamped) return std::nullopt;
    throw std::runtime_error(list.path + ": " + std::to_string(table.rows.size()) +
                             " rows hold a stamp and no name, but there are " +
                             std::to_string(pictures.pictures.size()) +
                             " pictures; expected \"stamp name\", or one stamp for each picture");
  }
  for (std::size_t k = 0; k < table.rows.size(); ++k)
    found.push_back({pictures.pictures[k], table.rows[k][*stamp_column]});
  return found;
}

}  // namespace evit::formats
