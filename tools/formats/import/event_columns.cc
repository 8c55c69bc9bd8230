#include "tools/formats/import/event_columns.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "common/files/table_reader.h"

namespace evit::formats {
namespace {

using Field = EventColumns::Field;
constexpr char kLayout[] = "t x y p";
constexpr std::size_t kTelling = 10;  // rows: fewer fit any order
constexpr double kSlowest = 0.01;     // s: events come more often than this

std::string Name(const std::string& word) {  // "t[us]" and "T_us" to "t"
  std::string name;
  for (const char c : word) {
    if (std::isalpha(static_cast<unsigned char>(c)) == 0) break;
    name += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  return name;
}

std::optional<Field> FieldNamed(const std::string& word) {
  const std::string name = Name(word);
  const auto is = [&](std::initializer_list<const char*> names) {
    return std::any_of(names.begin(), names.end(), [&](const char* n) { return name == n; });
  };
  if (is({"t", "ts", "time", "timestamp", "stamp"})) return EventColumns::kTime;
  if (is({"x", "u", "col", "column"})) return EventColumns::kX;
  if (is({"y", "v", "row"})) return EventColumns::kY;
  if (is({"p", "pol", "polarity", "sign"})) return EventColumns::kPolarity;
  return {};
}

// By the names, where all four are there.
bool ByHead(const TableSample& sample, EventColumns* columns) {
  const std::size_t n = sample.rows.empty() ? 0 : sample.rows.front().size();
  std::vector<ColumnName> head = NamedColumns(sample.head);
  if (head.size() + 1 == n) head.insert(head.begin(), {"", ""});  // an index column without a name (pandas)
  if (head.size() != n || n > columns->field.size()) return false;
  std::array<int, 4> found{};
  for (std::size_t k = 0; k < n; ++k) {
    columns->field[k] = FieldNamed(head[k].name).value_or(EventColumns::kIgnored);
    if (columns->field[k] != EventColumns::kIgnored) ++found[columns->field[k]];
  }
  columns->n = n;
  return found == std::array<int, 4>{1, 1, 1, 1};
}

bool IsPolarity(const std::string& word) {
  double value = 0;
  if (!ParseNumber(word, &value))
    return !word.empty() && std::isalpha(static_cast<unsigned char>(word[0])) != 0;
  return value == 0 || value == 1 || value == -1;
}

bool IsPixel(const std::string& word) {
  double value = 0;
  return ParseNumber(word, &value) && value == std::floor(value) && std::abs(value) < 8192;
}

// Whether the rows can be of this order.
bool Fits(const TableSample& sample, const std::array<Field, 4>& order) {
  double last = -INFINITY;
  std::size_t backward = 0;
  for (const auto& row : sample.rows) {
    for (std::size_t k = 0; k < 4; ++k) {
      if (order[k] == EventColumns::kPolarity && !IsPolarity(row[k])) return false;
      if ((order[k] == EventColumns::kX || order[k] == EventColumns::kY) && !IsPixel(row[k])) return false;
      double t = 0;
      if (order[k] != EventColumns::kTime) continue;
      if (!ParseNumber(row[k], &t)) return false;
      backward += t < last ? 1 : 0;
      last = t;
    }
  }
  return 3 * backward <= sample.rows.size();
}

// Takes a first row "width height" away.
std::optional<std::pair<int, int>> TakeSize(TableSample* sample) {
  double width = 0, height = 0;
  if (sample->rows.size() < 2 || sample->rows.front().size() != 2) return {};
  const bool numbers = ParseNumber(sample->rows[0][0], &width) && ParseNumber(sample->rows[0][1], &height);
  if (!numbers || !(width >= 1 && height >= 1 && width <= 8192 && height <= 8192)) return {};
  sample->rows.erase(sample->rows.begin());
  return std::pair(static_cast<int>(width), static_cast<int>(height));
}

}  // namespace

bool HoldsEvents(TableSample sample) {
  TakeSize(&sample);
  EventColumns columns;
  if (sample.rows.empty()) return false;
  if (ByHead(sample, &columns)) return true;
  double value = 0;
  const std::vector<std::string>& first = sample.rows.front();
  return first.size() == 4 &&
         std::all_of(
             first.begin(), first.end(),
             [&](const std::string& word) { return ParseNumber(word, &value) || IsPolarity(word); }) &&
         ParseNumber(first[1], &value);
}

EventColumns FindEventColumns(const std::string& path) {
  return FindEventColumns(SampleTable(path, kLayout));
}

EventColumns FindEventColumns(TableSample sample) {
  EventColumns columns;
  columns.size = TakeSize(&sample);
  // The reader itself says what is wrong with a row.
  sample.rows.erase(std::remove_if(sample.rows.begin(), sample.rows.end(),
                                   [&](const auto& row) { return row.size() != sample.rows.front().size(); }),
                    sample.rows.end());
  if (sample.rows.empty()) return columns;
  if (!ByHead(sample, &columns)) {
    columns.field = EventColumns().field;
    columns.n = 4;
    if (sample.rows.front().size() == 4 && sample.rows.size() >= kTelling) {
      constexpr Field t = EventColumns::kTime, x = EventColumns::kX, y = EventColumns::kY,
                      p = EventColumns::kPolarity;
      for (const std::array<Field, 4>& order :
           {std::array<Field, 4>{t, x, y, p}, {x, y, p, t}, {x, y, t, p}, {t, p, x, y}}) {
        if (!Fits(sample, order)) continue;
        std::copy(order.begin(), order.end(), columns.field.begin());
        break;
      }
    }
  }
  const auto time = std::find(columns.field.begin(), columns.field.end(), EventColumns::kTime);
  columns.unit = UnitOfStamps(sample, static_cast<std::size_t>(time - columns.field.begin()), kSlowest);
  return columns;
}

}  // namespace evit::formats
