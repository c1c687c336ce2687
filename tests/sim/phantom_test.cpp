#include "sim/phantom/phantom.hpp"

#include <cmath>
#include <numbers>
#include <set>
#include <vector>

#include <gtest/gtest.h>

namespace biotomy::sim {
namespace {

TEST(Phantom, IsTheSameForTheSameSeedAndAnotherForAnother) {
  const Phantom one(PhantomSettings{.seed = 7});
  const Phantom same(PhantomSettings{.seed = 7});
  const Phantom other(PhantomSettings{.seed = 8});
  int differing = 0;
  for (int i = 0; i < 100; ++i) {
    const double x = 97.0 * i;
    const double y = 9000 - 83.0 * i;
    EXPECT_EQ(one.colour_at(x, y, 5.0 * i), same.colour_at(x, y, 5.0 * i));
    differing += one.colour_at(x, y, 5.0 * i) == other.colour_at(x, y, 5.0 * i) ? 0 : 1;
  }
  EXPECT_GT(differing, 90);
}

TEST(Phantom, PaintsARowBitForBitAsItPaintsPoints) {
  const Phantom phantom{PhantomSettings{}};
  std::vector<Colour> row(1000);
  phantom.paint_row(0, 10, 3400, 120, row);
  for (std::size_t i = 0; i < row.size(); i += 13) {
    EXPECT_EQ(row[i], phantom.colour_at(10.0 * static_cast<double>(i), 3400, 120)) << i;
  }
}

TEST(Phantom, HasTheAnatomyWhereItBelongs) {
  const Phantom phantom{PhantomSettings{}};
  std::set<Tissue> condyle;
  for (double x = 4000; x < 5500; x += 20) {
    condyle.insert(phantom.tissue_at(x, 4200, 0));
  }
  EXPECT_TRUE(condyle.contains(Tissue::trabecula));
  EXPECT_TRUE(condyle.contains(Tissue::red_marrow));
  EXPECT_FALSE(condyle.contains(Tissue::muscle));
  std::set<Tissue> down_the_middle;
  for (double y = 0; y < 10000; y += 10) {
    down_the_middle.insert(phantom.tissue_at(4900, y, 0));
  }
  for (const Tissue tissue : {Tissue::casting, Tissue::cortical_bone, Tissue::yellow_marrow,
                              Tissue::trabecula, Tissue::cartilage, Tissue::synovia}) {
    EXPECT_TRUE(down_the_middle.contains(tissue)) << static_cast<int>(tissue);
  }
}

TEST(Phantom, HasEquallyFineTexturesAtEveryDepth) {
  PhantomSettings settings;
  settings.begins_um = 1e6;  // casting alone
  const Phantom phantom(settings);
  // The curvature along x over squares of a few millimetres, two cells of the finest texture deep.
  double least = 1e9;
  double most = 0;
  std::vector<Colour> row(200);
  for (double z = 0; z < 140; z += 10) {
    double sum = 0;
    for (double y = 0; y < 2000; y += 20) {
      phantom.paint_row(0, 10, y, z, row);
      for (std::size_t i = 1; i + 1 < row.size(); ++i) {
        const double curvature = row[i - 1].g - 2 * row[i].g + row[i + 1].g;
        sum += curvature * curvature;
      }
    }
    least = std::min(least, sum);
    most = std::max(most, sum);
  }
  EXPECT_LT(most, 1.15 * least);
}

TEST(Phantom, EndsRoundedWhereItIsToldTo) {
  const Phantom phantom{PhantomSettings{.begins_um = 100, .ends_um = 1000, .end_um = 200}};
  const auto width = [&](double z_um) {
    int inside = 0;
    for (double x = 0; x < 10000; x += 20) {
      inside += phantom.tissue_at(x, 4200, z_um) == Tissue::casting ? 0 : 1;
    }
    return inside;
  };
  EXPECT_EQ(width(90), 0);
  EXPECT_GT(width(110), 50);
  EXPECT_GT(width(200), 1.5 * width(110));
  EXPECT_GT(width(300), 1.1 * width(200));
  EXPECT_GT(width(990), 50);
  EXPECT_LT(width(990), 0.7 * width(800));
  EXPECT_EQ(width(1010), 0);
}

TEST(Phantom, IsSurroundedByGreenCastingInEveryLayer) {
  const Phantom phantom{PhantomSettings{}};
  for (double z = 0; z < 640; z += 40) {
    for (double along = 0; along < 10000; along += 250) {
      for (const auto& [x, y] :
           {std::pair(along, 100.0), {along, 9900.0}, {100.0, along}, {9900.0, along}}) {
        ASSERT_EQ(phantom.tissue_at(x, y, z), Tissue::casting) << x << ' ' << y << ' ' << z;
        const Colour c = phantom.colour_at(x, y, z);
        EXPECT_GT(c.g, 1.2F * c.r);
        EXPECT_GT(c.g, 1.2F * c.b);
      }
    }
  }
}

TEST(Phantom, StaysWithinTheLevelsOfAPhotograph) {
  const Phantom phantom{PhantomSettings{}};
  std::vector<Colour> row(500);
  for (double y = 0; y < 10000; y += 130) {
    phantom.paint_row(0, 20, y, 300, row);
    for (const Colour& c : row) {
      for (const float level : {c.r, c.g, c.b}) {
        ASSERT_GE(level, 0.0F);
        ASSERT_LE(level, 255.0F);
      }
    }
  }
}

TEST(Phantom, ChangesWithDepth) {
  const Phantom phantom{PhantomSettings{}};
  std::vector<Colour> first(1000);
  std::vector<Colour> last(1000);
  int changed = 0;
  for (double y = 1000; y < 9000; y += 500) {
    phantom.paint_row(0, 10, y, 0, first);
    phantom.paint_row(0, 10, y, 630, last);
    for (std::size_t i = 0; i < first.size(); ++i) {
      changed += std::fabs(first[i].r - last[i].r) > 30 ? 1 : 0;
    }
  }
  EXPECT_GT(changed, 1000);
}

// Of a sine of wavelength L, sampled at `step`, the bending energy is (2 pi step / L)^2 of the
// slope energy; of a single soft edge one detail wide L is 1.99 details. Walls with two edges close
// together and noise steeper than its mean come below that, but nothing comes near one detail.
TEST(Phantom, HoldsNothingFinerThanItsDetail) {
  const Phantom phantom{PhantomSettings{}};
  const double step = phantom.settings().detail_um / 7;
  std::vector<Colour> row(2000);
  double energy = 0;
  double bend = 0;
  for (double y = 1000; y < 9000; y += 200) {
    phantom.paint_row(0, step, y, 300, row);
    for (std::size_t i = 1; i + 1 < row.size(); ++i) {
      const double slope = 0.5 * (row[i + 1].r - row[i - 1].r);
      const double second = row[i + 1].r - 2 * row[i].r + row[i - 1].r;
      energy += slope * slope;
      bend += second * second;
    }
  }
  const double wavelength = 2 * std::numbers::pi * step / std::sqrt(bend / energy);
  EXPECT_GT(wavelength, 1.5 * phantom.settings().detail_um);
  EXPECT_LT(wavelength, 4.0 * phantom.settings().detail_um);  // and it is not blurred either
}

}  // namespace
}  // namespace biotomy::sim
