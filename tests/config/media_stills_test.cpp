// SPDX-License-Identifier: Apache-2.0
//
// Pictures by their colours, paintings, SVG drawings and lettering, as the child process makes them.
#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>

#include "config/media.hpp"
#include "tests/config/show_folder.hpp"

namespace footlight::config {
namespace {

class Stills : public testing::Test {
 protected:
  [[nodiscard]] std::string file(const std::string& name) const { return folder_.path(name).string(); }
  /// Three columns: grey 0x20, red, and nothing at all.
  std::string colours() const {
    cv::Mat image(2, 3, CV_8UC4, cv::Scalar(0, 0, 0, 0));
    for (int y = 0; y < 2; ++y) {
      image.at<cv::Vec4b>(y, 0) = {0x20, 0x20, 0x20, 255};
      image.at<cv::Vec4b>(y, 1) = {0, 0, 255, 255};
    }
    cv::imwrite(file("colours.png"), image);
    return file("colours.png");
  }
  Result<Film, PartFailure> drawn(Drawing drawing) const {
    Part part;
    part.drawing = std::move(drawing);
    return decode_parts({std::make_shared<const std::vector<Part>>(std::vector<Part>{part})});
  }
  std::string refused(Drawing drawing) const {
    const auto film = drawn(std::move(drawing));
    return film ? "decoded" : folder_.without_folder(film.error().error.message);
  }
  std::string svg_refused(const std::string& text) const {
    folder_.write("a.svg", text);
    return refused(Picture{file("a.svg"), {}});
  }

  ShowFolder folder_;
};

int drawn_pixels(const Mask& mask) {
  int out = 0;
  for (int y = 0; y < mask.height(); ++y) {
    for (int x = 0; x < mask.width(); ++x) out += mask.at(x, y) ? 1 : 0;
  }
  return out;
}

TEST_F(Stills, APictureIsWhatLiesBetweenTwoColours) {
  PictureOptions options;
  options.colour = ColourRange{{0x10, 0x10, 0x10}, {0x40, 0x40, 0x40}};
  const auto film = decode_image({colours(), options});
  ASSERT_TRUE(film) << film.error();
  EXPECT_TRUE(film->frames.at(0).at(0, 0));
  EXPECT_EQ(drawn_pixels(film->frames.at(0)), 2);
  options.colour->from = {0, 0, 0};  // what is transparent has no colour
  EXPECT_EQ(drawn_pixels(decode_image({colours(), options})->frames.at(0)), 2);
  options.invert = true;
  EXPECT_EQ(drawn_pixels(decode_image({colours(), options})->frames.at(0)), 4);
}

TEST_F(Stills, APaintingIsItsColoursOnWhite) {
  const auto film = decode_painting({colours()});
  ASSERT_TRUE(film) << film.error();
  EXPECT_EQ(film->width, 3);
  EXPECT_EQ(film->height, 2);
  EXPECT_TRUE(film->frames.empty());
  EXPECT_EQ(film->rgb, (std::vector<std::uint8_t>{0x20, 0x20, 0x20, 255, 0, 0, 255, 255, 255,  //
                                                  0x20, 0x20, 0x20, 255, 0, 0, 255, 255, 255}));
}

TEST_F(Stills, APaintingThatIsNoneIsRefused) {
  folder_.write("a.png", "no picture");
  const auto film = decode_painting({file("a.png")});
  ASSERT_FALSE(film);
  EXPECT_EQ(folder_.without_folder(film.error().message),
            "'a.png' cannot be decoded as an image (a whole file is needed: PNG, JPEG, BMP, PBM, PGM or SVG, of 1 to "
            "16777216 pixels)");
}

TEST_F(Stills, ABombOfAPictureIsRefused) {
  cv::imwrite(file("bomb.png"), cv::Mat(1000, 17000, CV_8U, cv::Scalar(0)));  // 17 million pixels
  ASSERT_LT(std::filesystem::file_size(file("bomb.png")), 100'000U);
  const std::string refusal =
      "'bomb.png' cannot be decoded as an image (a whole file is needed: PNG, JPEG, BMP, PBM, PGM or SVG, of 1 to "
      "16777216 pixels)";
  EXPECT_EQ(refused(Picture{file("bomb.png"), {}}), refusal);
  const auto painting = decode_painting({file("bomb.png")});
  ASSERT_FALSE(painting);
  EXPECT_EQ(folder_.without_folder(painting.error().message), refusal);
}

TEST_F(Stills, LetteringIsWhatTheFontDrawsOfAnyScript) {
  const auto film = drawn(Lettering{"走", "Noto Sans CJK SC Bold"});
  ASSERT_TRUE(film) << film.error().error;
  EXPECT_GT(film->height, 200);
  EXPECT_LT(film->height, 300);
  const double share = static_cast<double>(drawn_pixels(film->frames.at(0))) / (film->width * film->height);
  EXPECT_GT(share, 0.2);
  EXPECT_LT(share, 0.7);
  const auto lines = drawn(Lettering{"I\nI", "DejaVu Sans"});
  ASSERT_TRUE(lines) << lines.error().error;
  EXPECT_GT(lines->height, 8 * lines->width);
}

TEST_F(Stills, LetteringOfNoFontGivenIsThatOfWhicheverHasTheCharacters) {
  const auto film = drawn(Lettering{"A走", ""});
  ASSERT_TRUE(film) << film.error().error;
  EXPECT_GT(film->width, film->height);
}

TEST_F(Stills, LongLetteringStaysWithinBounds) {
  const auto film = drawn(Lettering{std::string(600, 'M'), "DejaVu Sans"});
  ASSERT_TRUE(film) << film.error().error;
  EXPECT_LE(film->width, 4096);
  EXPECT_GT(film->width, 3000);
}

TEST_F(Stills, AFontWithoutTheCharacterSaysWhichAndDrawsNoBoxes) {
  EXPECT_EQ(refused(Lettering{"ab走", "DejaVu Sans"}),
            "the font 'DejaVu Sans' has no character '走' (U+8D70) (another font may have it)");
}

TEST_F(Stills, AnUnknownFontIsRefused) {
  EXPECT_EQ(refused(Lettering{"a", "No Such Font Bold"}),
            "no font here is called 'No Such Font Bold' (fc-list shows their names; as Noto Sans CJK SC Bold)");
}

TEST_F(Stills, LetteringWithoutInkIsRefused) {
  EXPECT_EQ(refused(Lettering{"\xE3\x80\x80", "Noto Sans CJK SC"}),
            "nothing is drawn by '\xE3\x80\x80' (a drawing has a size and something in it)");
}

TEST_F(Stills, PicturesOfSeveralPartsHaveOneSize) {
  std::vector<Part> parts(3);
  parts[0].drawing = Lettering{"I", "DejaVu Sans"};
  parts[2].drawing = Picture{colours(), {}};
  const auto film = decode_parts({std::make_shared<const std::vector<Part>>(parts)});
  ASSERT_TRUE(film) << film.error().error;
  ASSERT_EQ(film->frames.size(), 2U);
  EXPECT_EQ(film->frames[1].height(), film->height);
  EXPECT_EQ(drawn_pixels(film->frames[1]), 2) << "the red ones are brighter than the grey ones";
  EXPECT_TRUE(film->frames[1].at(1, 1));
}

#if FOOTLIGHT_WITH_RSVG
TEST_F(Stills, AnSvgDrawingIsWhatItPaints) {
  folder_.write("a.svg",
                "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 40 20'><rect width='20' height='20'/></svg>");
  const auto film = decode_image({file("a.svg"), {}});
  ASSERT_TRUE(film) << film.error();
  EXPECT_EQ(film->width, 1024);
  EXPECT_EQ(film->height, 512);
  EXPECT_EQ(drawn_pixels(film->frames.at(0)), 512 * 512);
  EXPECT_TRUE(film->frames.at(0).at(511, 511));
}

TEST_F(Stills, ABrokenSvgDrawingIsRefused) {
  EXPECT_EQ(svg_refused("<svg xmlns='http://www.w3.org/2000/svg'><rect"),
            "'a.svg' cannot be decoded as an image (a whole file is needed: PNG, JPEG, BMP, PBM, PGM or SVG, of 1 to "
            "16777216 pixels)");
  EXPECT_EQ(svg_refused("<svg xmlns='http://www.w3.org/2000/svg'/>"),
            "nothing is drawn by 'a.svg' (a drawing has a size and something in it)");
}

TEST_F(Stills, AnSvgDrawingThatAsksForOtherFilesIsRefused) {
  const std::string refusal = "'a.svg' refers to other files, which are not read (put everything into one)";
  const std::string head =
      "<svg xmlns='http://www.w3.org/2000/svg' xmlns:xlink='http://www.w3.org/1999/xlink' width='9' height='9'>";
  for (const char* body : {"<image xlink:href='b.png' width='9' height='9'/>", "<use href='http://x.org/a.svg#b'/>",
                           "<rect width='9' height='9' style='fill: url(b.svg#c)'/>",
                           "<style>@import 'b.css';</style><rect width='9' height='9'/>"}) {
    EXPECT_EQ(svg_refused(head + body + "</svg>"), refusal) << body;
  }
  EXPECT_EQ(svg_refused("<!DOCTYPE svg [<!ENTITY a SYSTEM 'file:///etc/passwd'>]>" + head + "<text>&a;</text></svg>"),
            refusal);
  EXPECT_EQ(svg_refused(head + "<a href='http://x.org'><rect id='b' width='9' height='9'/></a><use href='#b'/></svg>"),
            "decoded");
}
#endif

}  // namespace
}  // namespace footlight::config
