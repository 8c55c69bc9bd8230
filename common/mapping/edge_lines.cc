#include "common/mapping/edge_lines.h"

#include <cstddef>

namespace evit {

std::vector<EdgePixel> KeepLines(const cv::Mat& index, const std::vector<EdgePixel>& found,
                                 const std::vector<char>& sure, int min_length) {
  std::vector<char> seen(found.size(), 0), kept(found.size(), 0);
  std::vector<cv::Point> line;
  for (int row = 1; row + 1 < index.rows; ++row) {
    for (int column = 1; column + 1 < index.cols; ++column) {
      const int start = index.at<int>(row, column);
      if (start < 0 || seen[start] != 0 || sure[start] == 0) continue;
      line.assign(1, {column, row});
      seen[start] = 1;
      for (std::size_t k = 0; k < line.size(); ++k) {
        for (int dy = -1; dy <= 1; ++dy) {
          for (int dx = -1; dx <= 1; ++dx) {
            const cv::Point next = line[k] + cv::Point(dx, dy);
            const int at = index.at<int>(next);
            if (at < 0 || seen[at] != 0) continue;
            seen[at] = 1;
            line.push_back(next);
          }
        }
      }
      if (line.size() < static_cast<std::size_t>(min_length)) continue;
      for (const cv::Point& p : line) kept[index.at<int>(p)] = 1;
    }
  }
  std::vector<EdgePixel> edges;
  for (std::size_t k = 0; k < found.size(); ++k) {
    if (kept[k] != 0) edges.push_back(found[k]);
  }
  return edges;
}

}  // namespace evit
