#include "common/mapping/edge_lines.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace evit {
namespace {

constexpr int kReach = 4;              // pixels along a line
constexpr float kAside = 1.5F;         // pixels across it
constexpr float kSameWay = 0.85F;      // cosine of the angle between two normals of one line
constexpr int kLeast = 5;              // pixels of a line that tell its direction
constexpr float kMostTurned = 0.35F;   // rad; more and it is a corner
constexpr float kLeastLength2 = 2.5F;  // variance along the line, pixels^2

}  // namespace

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

void FitNormals(const cv::Mat& index, std::vector<EdgePixel>* found) {
  std::vector<Eigen::Vector2f> normals(found->size());
  for (int row = 0; row < index.rows; ++row) {
    for (int column = 0; column < index.cols; ++column) {
      const int own = index.at<int>(row, column);
      if (own < 0) continue;
      const EdgePixel& edge = (*found)[own];
      normals[own] = edge.normal;
      const Eigen::Vector2f tangent(edge.normal.y(), -edge.normal.x());
      // Across as a linear function of along.
      float n = 0, a = 0, b = 0, aa = 0, ab = 0;
      for (int y = std::max(0, row - kReach); y <= std::min(index.rows - 1, row + kReach); ++y) {
        for (int x = std::max(0, column - kReach); x <= std::min(index.cols - 1, column + kReach); ++x) {
          const int at = index.at<int>(y, x);
          if (at < 0) continue;
          const EdgePixel& other = (*found)[at];
          const Eigen::Vector2f off = other.pixel - edge.pixel;
          const float across = off.dot(edge.normal), along = off.dot(tangent);
          if (std::abs(across) > kAside || other.normal.dot(edge.normal) < kSameWay) continue;
          n += 1, a += along, b += across, aa += along * along, ab += along * across;
        }
      }
      const float spread = aa - a * a / n;
      if (n < kLeast || spread < kLeastLength2 * n) continue;
      const float slope = (ab - a * b / n) / spread;
      if (std::abs(slope) > kMostTurned) continue;
      normals[own] = (edge.normal - slope * tangent).normalized();
    }
  }
  for (std::size_t k = 0; k < found->size(); ++k) (*found)[k].normal = normals[k];
}

}  // namespace evit
