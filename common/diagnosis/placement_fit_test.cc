#include "common/diagnosis/placement_fit.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/helpers/line_world.h"

namespace evit::diagnosis {
namespace {

using Kind = Misplacement::Kind;

constexpr int kFitExcerpts = 6;
constexpr Kind kKinds[] = {Kind::kTime,  Kind::kRotation, Kind::kShift,
                           Kind::kScale, Kind::kFocal,    Kind::kCentre};

// The lines as a camera sees them that has `wrong` in it, where the world is thought to be as it should.
struct FitScene {
  explicit FitScene(const Misplacement& wrong = {})
      : map(test::Lines()),
        given(test::LineWorld()),
        excerpts(test::EventsOf(map.map(), Corrected(given, wrong), test::Instants(kFitExcerpts))) {}
  std::vector<MapView> Views() const { return PlacementViews(map, given, excerpts); }

  MapIndex map;
  World given;
  EventExcerpts excerpts;
};

PlacementFit FitOf(const std::map<Utime, double>& overlaps) { return {{}, overlaps, 0}; }

TEST(PlacementFit, TimeScaleAndFocalLengthHaveOneUnknown) {
  const auto one = [](Kind kind) { return PlacementFit{{kind, {}, 0}, {}, 0}.OneUnknown(); };
  EXPECT_TRUE(one(Kind::kTime) && one(Kind::kScale) && one(Kind::kFocal));
  EXPECT_FALSE(one(Kind::kRotation) || one(Kind::kShift) || one(Kind::kCentre));
}

TEST(PlacementFit, ViewsHoldWhatASmallCorrectionBringsIntoView) {
  const FitScene scene;
  const Camera& camera = scene.given.rig.camera;
  const std::vector<MapView> views = scene.Views();
  ASSERT_EQ(views.size(), static_cast<std::size_t>(kFitExcerpts));
  double farthest = 0;
  for (const MapView& view : views) {
    EXPECT_GT(view.n_events, 0);
    const SE3 T_camera_map = (view.T_map_body * scene.given.rig.T_body_camera).Inverse();
    for (const Eigen::Vector3f& p : view.points) {
      Eigen::Vector2d pixel;
      ASSERT_TRUE(camera.Project(T_camera_map * p.cast<double>(), &pixel));
      farthest = std::max({farthest, -pixel.x(), pixel.x() - camera.width});
    }
  }
  EXPECT_GT(farthest, 0.08 * camera.width);
  EXPECT_LT(farthest, 0.12 * camera.width);
}

TEST(PlacementFit, NothingIsToldByFewViewsOrAFewOfManyExcerpts) {
  const auto enough = [](std::size_t views, int excerpts) {
    return EnoughViews(std::vector<MapView>(views), EventExcerpts(test::Instants(excerpts), 1));
  };
  EXPECT_TRUE(enough(5, 5));
  EXPECT_TRUE(enough(5, 10));
  EXPECT_FALSE(enough(4, 4));
  EXPECT_FALSE(enough(5, 11));
}

// Measured in the views of the world as given, or in those of the world as it should be: the same.
TEST(PlacementFit, MeasuresTheWorldAsItWouldBeWithoutTheMisplacement) {
  for (const Kind kind : kKinds) {
    const Misplacement wrong{kind, 3 * Tolerance(kind) * Eigen::Vector3d(1, kind == Kind::kCentre ? 1 : 0, 0),
                             0};
    const FitScene scene(wrong);
    const PlacementFit as_given = MeasurePlacement(scene.given, scene.Views(), {});
    const PlacementFit corrected = MeasurePlacement(scene.given, scene.Views(), wrong);
    const World there = Corrected(scene.given, wrong);
    const PlacementFit as_corrected =
        MeasurePlacement(there, PlacementViews(scene.map, there, scene.excerpts), {});
    EXPECT_LT(as_given.overlap, 0.5) << static_cast<int>(kind);
    EXPECT_GT(corrected.overlap, 0.7) << static_cast<int>(kind);
    EXPECT_GT(as_corrected.overlap, 0.7) << static_cast<int>(kind);
    EXPECT_EQ(corrected.misplacement.kind, kind);
    EXPECT_EQ(corrected.misplacement.value, wrong.value);
    EXPECT_GT(Better(corrected, as_given), 4);
  }
}

TEST(PlacementFit, HasTheOverlapOfEachViewByItsInstant) {
  const FitScene scene;
  std::vector<MapView> views = scene.Views();
  const PlacementFit fit = MeasurePlacement(scene.given, views, {});
  ASSERT_EQ(fit.overlaps.size(), views.size());
  double sum = 0;
  for (const Utime instant : scene.excerpts.instants()) {
    ASSERT_EQ(fit.overlaps.count(instant), 1U) << instant;
    sum += fit.overlaps.at(instant);
  }
  EXPECT_NEAR(sum / kFitExcerpts, fit.overlap, 0.1);
  for (MapView& view : views) view.points.resize(40);
  EXPECT_EQ(MeasurePlacement(scene.given, views, {}).overlap, 0) << "too few points to tell";
}

TEST(PlacementFit, BetterCountsStandardErrorsOfTheMeanGain) {
  const PlacementFit a = FitOf({{1, 0.3}, {2, 0.5}, {3, 0.6}}), b = FitOf({{1, 0.2}, {2, 0.3}, {3, 0.3}});
  EXPECT_NEAR(Better(a, b), 0.2 / (0.1 / std::sqrt(3)), 1e-9);
  EXPECT_NEAR(Better(b, a), -Better(a, b), 1e-9);
  EXPECT_EQ(Better(a, a), 0);
  EXPECT_EQ(Better(FitOf({{1, 0.9}}), FitOf({{1, 0.1}})), 0) << "one view";
}

TEST(PlacementFit, BetterTakesAViewThatOnlyOneHasAsZeroInTheOther) {
  const PlacementFit both = FitOf({{1, 0.3}, {2, 0.2}}), first = FitOf({{1, 0.2}});
  EXPECT_EQ(Better(both, first), Better(both, FitOf({{1, 0.2}, {2, 0}})));
  EXPECT_EQ(Better(first, both), Better(FitOf({{1, 0.2}, {2, 0}}), both));
}

TEST(PlacementFit, RefinedFindsTheRestOfItsKind) {
  const Misplacement wrong{Kind::kFocal, {0.12, 0, 0}, 0};
  const FitScene scene(wrong);
  const PlacementFit coarse = MeasurePlacement(scene.given, scene.Views(), {Kind::kFocal, {0.09, 0, 0}, 0});
  const PlacementFit fine = Refined(scene.map, scene.given, scene.excerpts, coarse);
  EXPECT_EQ(fine.misplacement.kind, Kind::kFocal);
  EXPECT_NEAR(fine.misplacement.value.x(), 0.12, 0.01);
  EXPECT_GT(fine.overlap, coarse.overlap + 0.1);
}

// Otherwise a kind with three unknowns would win by what it takes up of the turn or shift.
TEST(PlacementFit, RefinedForgivesATurnOrShiftThatGoodCalibrationsLeave) {
  const Misplacement focal{Kind::kFocal, {0.08, 0, 0}, 0};
  for (const Kind kind : {Kind::kRotation, Kind::kShift}) {
    for (const double size : {0.8, 3.0}) {
      const Misplacement left{kind, size * Tolerance(kind) * Eigen::Vector3d(0.6, 0.8, 0), 0};
      FitScene scene;
      const World there = Corrected(scene.given, focal);
      scene.excerpts = test::EventsOf(scene.map.map(), Corrected(there, left), test::Instants(kFitExcerpts));
      const PlacementFit fit = MeasurePlacement(scene.given, scene.Views(), focal);
      const PlacementFit refined = Refined(scene.map, scene.given, scene.excerpts, fit);
      const double without =
          MeasurePlacement(there, PlacementViews(scene.map, there, scene.excerpts), left).overlap;
      EXPECT_EQ(refined.misplacement.kind, Kind::kFocal);
      if (size < 1) {
        EXPECT_NEAR(refined.misplacement.value.x(), 0.08, 0.03);
        EXPECT_GT(refined.overlap, without - 0.1) << static_cast<int>(kind);
        EXPECT_GT(refined.overlap, fit.overlap + 0.1) << static_cast<int>(kind);
      } else {
        EXPECT_LT(refined.overlap, without - 0.3) << static_cast<int>(kind);
      }
    }
  }
}

TEST(PlacementFit, RefinedKeepsWhatItCannotMend) {
  const FitScene scene;
  PlacementFit best = MeasurePlacement(scene.given, scene.Views(), {Kind::kFocal, {0.001, 0, 0}, 0});
  best.overlap = 1;
  const PlacementFit refined = Refined(scene.map, scene.given, scene.excerpts, best);
  EXPECT_EQ(refined.overlap, 1);
  EXPECT_EQ(refined.misplacement.value.x(), 0.001);
}

TEST(PlacementFit, FarScalesAreFoundEitherWay) {
  for (const double scale : {-0.28, 0.35}) {
    const FitScene scene({Kind::kScale, {scale, 0, 0}, 0});
    const std::optional<PlacementFit> far = FindFarScale(scene.map, scene.given, scene.excerpts);
    ASSERT_TRUE(far);
    EXPECT_EQ(far->misplacement.kind, Kind::kScale);
    EXPECT_NEAR(far->misplacement.value.x(), scale, 0.015);
    EXPECT_GT(far->overlap, 0.6);
  }
}

TEST(PlacementFit, FarScalesNeedViews) {
  const FitScene scene;
  EXPECT_FALSE(
      FindFarScale(scene.map, scene.given, test::EventsOf(scene.map.map(), scene.given, test::Instants(4))));
}

}  // namespace
}  // namespace evit::diagnosis
