#include "acquisition/viewer/exports/export_order.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "reconstruct/errors.hpp"
#include "tests/reconstruct/test_files.hpp"

namespace biotomy::acquisition {
namespace {

using reconstruct::InvalidRequest;
using reconstruct::message_of;
using testing::HasSubstr;

TEST(AnExportOrder, IsReadFromTextsAndNumbers) {
  const ExportOrder order = export_order(
      R"({"kind":"section","format":"tiff","parameters":{"points":"0,0,0 1,0,0 0,1,0","pixel":7.5}})");
  ASSERT_TRUE(order.section);
  EXPECT_EQ(order.section->format, "tiff");
  EXPECT_EQ(order.section->parameters.pixel, "7.5");
}

TEST(AnExportOrder, OfASeriesHasItsParametersBeside) {
  const ExportOrder order = export_order(
      R"({"kind":"series","format":"png","parameters":{"theta":"inscribed"},
          "series":{"kind":"rotate","axis":"x","step":3},"movie":true,"frames":false,"rate":12.5})");
  ASSERT_TRUE(order.series);
  EXPECT_EQ(order.series->series.step, "3");
  EXPECT_EQ(order.series->style.parameters.theta, "inscribed");
  EXPECT_TRUE(order.movie);
  EXPECT_FALSE(order.frames);
  EXPECT_EQ(order.rate, 12.5);
}

TEST(AnExportOrder, SaysWhatIsWrongWithIt) {
  const auto refusal = [](const std::string& body) {
    return message_of<InvalidRequest>([&] { export_order(body); });
  };
  EXPECT_THAT(refusal("no JSON"), HasSubstr("must be a JSON object"));
  EXPECT_THAT(refusal("{}"), HasSubstr("kind must be a text"));
  EXPECT_THAT(refusal(R"({"kind":"film"})"), HasSubstr("there are section and series"));
  EXPECT_THAT(refusal(R"({"kind":"section","paramters":{}})"),
              HasSubstr("did you mean parameters"));
  EXPECT_THAT(refusal(R"({"kind":"section","parameters":[]})"), HasSubstr("must be an object"));
  EXPECT_THAT(refusal(R"({"kind":"section","parameters":{"points":[0]}})"),
              HasSubstr("parameters.points must be a text or a number"));
  EXPECT_THAT(refusal(R"({"kind":"section","parameters":{"fit":"9x9"}})"), HasSubstr("fit"));
  EXPECT_THAT(refusal(R"({"kind":"section","movie":true})"), HasSubstr("no movie"));
  EXPECT_THAT(refusal(R"({"kind":"series","series":{"kind":"rotate"},"frames":false})"),
              HasSubstr("nothing to export"));
  EXPECT_THAT(refusal(R"({"kind":"series","series":{"kind":"rotate"},"rate":0})"),
              HasSubstr("rate"));
  EXPECT_THAT(refusal(R"({"kind":"series","series":{"kind":"rotate"},"movie":1})"),
              HasSubstr("movie must be true or false"));
}

}  // namespace
}  // namespace biotomy::acquisition
