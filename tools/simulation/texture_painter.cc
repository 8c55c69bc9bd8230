#include "tools/simulation/texture_painter.h"

#include <algorithm>
#include <opencv2/imgproc.hpp>
#include <vector>

namespace evit::simulation {
namespace {

// Pictures are painted at twice their resolution and then averaged, which smooths the shapes' borders.
struct Canvas {
  cv::Mat image;
  double metre;  // texels of the canvas per metre
  double base;
  Random* random;

  double w() const { return image.cols; }
  double h() const { return image.rows; }
  cv::Scalar Grey(double spread) const {
    return cv::Scalar(std::clamp(base + random->Uniform(-spread, spread), 12.0, 245.0));
  }
  // A grey that stands out from the base by 45 to 120.
  cv::Scalar Contrast() const {
    const double step = random->Uniform(45, 120);
    const bool up = base + step < 245 && (base - step < 12 || random->Chance(0.5));
    return cv::Scalar(std::clamp(up ? base + step : base - step, 12.0, 245.0));
  }
  cv::Point Place() const {
    const double x = random->Uniform(0, w()), y = random->Uniform(0, h());
    return {static_cast<int>(x), static_cast<int>(y)};
  }
  int Length(double low, double high) const {
    return std::max(2, static_cast<int>(random->Uniform(low, high) * metre));
  }
};

void PaintGradient(const Canvas& c) {
  cv::Mat image = c.image;  // shares the pixels
  const double gx = c.random->Uniform(-40, 40), gy = c.random->Uniform(-40, 40);
  for (int y = 0; y < c.image.rows; ++y) {
    for (int x = 0; x < c.image.cols; ++x) {
      image.at<float>(y, x) = static_cast<float>(
          std::clamp(c.base + gx * (x / c.w() - 0.5) + gy * (y / c.h() - 0.5), 12.0, 245.0));
    }
  }
}

void PaintShapes(const Canvas& c) {
  const int n = std::clamp(static_cast<int>(c.w() * c.h() / (c.metre * c.metre) * 45), 5, 80);
  for (int i = 0; i < n; ++i) {
    const cv::Point a = c.Place();
    const int r = c.Length(0.02, 0.11);
    const int kind = c.random->Integer(0, 3);
    if (kind == 0) {
      cv::circle(c.image, a, r, c.Contrast(), cv::FILLED);
    } else if (kind == 1) {
      const int h = c.Length(0.02, 0.11);
      cv::rectangle(c.image, {a.x - r, a.y - h, 2 * r, 2 * h}, c.Contrast(), cv::FILLED);
    } else if (kind == 2) {
      const double angle = c.random->Uniform(0, 6.28);
      std::vector<cv::Point> corners;
      corners.reserve(3);
      for (int k = 0; k < 3; ++k) {
        corners.emplace_back(a.x + static_cast<int>(1.3 * r * std::cos(angle + 2.1 * k)),
                             a.y + static_cast<int>(1.3 * r * std::sin(angle + 2.1 * k)));
      }
      cv::fillConvexPoly(c.image, corners, c.Contrast());
    } else {
      cv::line(c.image, a, c.Place(), c.Contrast(), c.Length(0.008, 0.02));
    }
  }
}

void PaintText(const Canvas& c) {
  const int line = c.Length(0.03, 0.06), margin = c.Length(0.02, 0.05);
  const cv::Scalar ink = c.Contrast();
  for (int y = margin; y + line < c.image.rows - margin / 2; y += line + line / 2) {
    int x = margin;
    const int stop = static_cast<int>(c.w() * c.random->Uniform(0.5, 1)) - margin;
    while (x < stop) {
      const int glyph = std::max(2, static_cast<int>(line * c.random->Uniform(0.25, 0.6)));
      if (!c.random->Chance(0.18)) {
        const int top = c.random->Chance(0.4) ? 0 : line / 3;
        cv::rectangle(c.image, {x, y + top, glyph, line - top}, ink, cv::FILLED);
        if (c.random->Chance(0.5)) {
          cv::rectangle(c.image, {x + glyph / 3, y + top + (line - top) / 3, glyph / 3, line / 4},
                        cv::Scalar(c.base), cv::FILLED);
        }
      }
      x += glyph + std::max(2, line / 6);
    }
  }
}

void PaintChecker(const Canvas& c, bool stripes) {
  const int field = c.Length(0.05, 0.11);
  const cv::Scalar other = c.Contrast();
  for (int y = 0; y < c.image.rows; y += stripes ? c.image.rows : field) {
    for (int x = 0; x < c.image.cols; x += field) {
      if ((x / field + (stripes ? 0 : y / field)) % 2 == 0) continue;
      cv::rectangle(c.image, {x, y, field, stripes ? c.image.rows : field}, other, cv::FILLED);
    }
  }
}

// Sum of upscaled random fields, `share` of each octave's amplitude going on to the next.
cv::Mat Noise(const Canvas& c, double first_cell_x, double first_cell_y, int octaves, double share) {
  cv::Mat sum = cv::Mat::zeros(c.image.size(), CV_32F);
  double amplitude = 1;
  for (int i = 0; i < octaves; ++i) {
    const double scale = 1.0 / (1 << i) * c.metre;
    cv::Mat field(std::max(2, static_cast<int>(c.h() / (first_cell_y * scale)) + 2),
                  std::max(2, static_cast<int>(c.w() / (first_cell_x * scale)) + 2), CV_32F);
    for (int k = 0; k < field.rows * field.cols; ++k) {
      field.at<float>(k / field.cols, k % field.cols) = static_cast<float>(c.random->Uniform(-1, 1));
    }
    cv::Mat large;
    cv::resize(field, large, c.image.size(), 0, 0, cv::INTER_CUBIC);
    sum += amplitude * large;
    amplitude *= share;
  }
  return sum;
}

void PaintPhoto(const Canvas& c) {
  cv::Mat image = c.image;  // shares the pixels
  const cv::Mat noise = Noise(c, 0.25, 0.25, 3, 0.5);
  const double level1 = c.random->Uniform(-0.3, 0), level2 = c.random->Uniform(0.2, 0.5);
  for (int y = 0; y < c.image.rows; ++y) {
    for (int x = 0; x < c.image.cols; ++x) {
      const float v = noise.at<float>(y, x);
      const double step = (v > level1 ? 45 : -20) + (v > level2 ? 35 : 0);
      image.at<float>(y, x) = static_cast<float>(std::clamp(c.base + step + 20 * v, 12.0, 245.0));
    }
  }
}

void PaintTiles(const Canvas& c) {
  const int field = c.Length(0.35, 0.6), joint = c.Length(0.008, 0.014);
  const cv::Scalar dark(std::max(14.0, c.base * 0.6));
  for (int x = 0; x < c.image.cols; x += field) {
    for (int y = 0; y < c.image.rows; y += field) {
      cv::rectangle(c.image, {x, y, field, field}, c.Grey(7), cv::FILLED);
    }
  }
  for (int x = 0; x < c.image.cols; x += field) cv::rectangle(c.image, {x, 0, joint, c.image.rows}, dark, -1);
  for (int y = 0; y < c.image.rows; y += field) cv::rectangle(c.image, {0, y, c.image.cols, joint}, dark, -1);
}

}  // namespace

cv::Mat PaintPicture(Paint paint, int width, int height, double texel_size, double base, Random* random) {
  Canvas c{cv::Mat(2 * height, 2 * width, CV_32F, cv::Scalar(base)), 2 / texel_size, base, random};
  switch (paint) {
    case Paint::kPlain:
      break;
    case Paint::kGradient:
      PaintGradient(c);
      break;
    case Paint::kShapes:
      PaintShapes(c);
      break;
    case Paint::kText:
      PaintText(c);
      break;
    case Paint::kChecker:
      PaintChecker(c, false);
      break;
    case Paint::kStripes:
      PaintChecker(c, true);
      break;
    case Paint::kPhoto:
      PaintPhoto(c);
      break;
    case Paint::kWood:
      c.image = c.image + 0.09 * base * Noise(c, 0.8, 0.03, 2, 0.6);
      break;
    case Paint::kTiles:
      PaintTiles(c);
      break;
  }
  cv::Mat picture;
  cv::resize(c.image, picture, {width, height}, 0, 0, cv::INTER_AREA);
  return picture;
}

}  // namespace evit::simulation
