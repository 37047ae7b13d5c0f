// SPDX-License-Identifier: Apache-2.0
#include "config/decode_still.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <fstream>
#include <string_view>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

namespace footlight::config {
namespace {

/// Only formats with small, much tested readers; OpenCV alone would try a dozen more.
bool is_listed_bitmap(std::string_view head) {
  const auto starts = [&](std::string_view with) { return head.substr(0, with.size()) == with; };
  return starts("\x89PNG\r\n\x1A\n") || starts("\xFF\xD8\xFF") || starts("BM") || starts("P1") || starts("P2") ||
         starts("P4") || starts("P5");
}

/// What is transparent is dark.
cv::Mat grey_on_black(const cv::Mat& bgra) {
  cv::Mat grey;
  cv::Mat alpha;
  cv::cvtColor(bgra, grey, cv::COLOR_BGRA2GRAY);
  cv::extractChannel(bgra, alpha, 3);
  cv::multiply(grey, alpha, grey, 1.0 / 255);
  return grey;
}

Still read_bitmap(const std::string& path) {
  Still out;
  cv::Mat image = cv::imread(path, cv::IMREAD_UNCHANGED);
  if (image.depth() == CV_16U) image.convertTo(image, CV_8U, 1.0 / 257);
  if (image.empty() || image.depth() != CV_8U) return out;
  if (image.channels() == 1) {
    out.grey = image;
    cv::cvtColor(image, out.bgra, cv::COLOR_GRAY2BGRA);
  } else if (image.channels() == 3) {
    cv::cvtColor(image, out.grey, cv::COLOR_BGR2GRAY);
    cv::cvtColor(image, out.bgra, cv::COLOR_BGR2BGRA);
  } else if (image.channels() == 4) {
    out.grey = grey_on_black(image);
    out.bgra = image;
  } else {
    return out;
  }
  out.status = DecodeStatus::ok;
  return out;
}

}  // namespace

Still read_still(const std::string& path) {
  std::array<char, 4096> head{};
  std::ifstream in(path, std::ios::binary);
  in.read(head.data(), head.size());
  const std::string_view begin(head.data(), static_cast<std::size_t>(in.gcount()));
  in.close();
  if (is_listed_bitmap(begin)) return read_bitmap(path);
  const std::size_t text = begin.find_first_not_of("\xEF\xBB\xBF \t\r\n");
  const bool is_xml = text != std::string_view::npos && begin[text] == '<';
  return is_xml && begin.find("svg") != std::string_view::npos ? read_svg(path) : Still{};
}

std::optional<ColourRange> colours_from(const std::string& text) {
  if (text.size() != 12) return std::nullopt;
  std::array<std::uint8_t, 6> bytes{};
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    const char* at = text.data() + 2 * i;
    if (const auto [end, error] = std::from_chars(at, at + 2, bytes[i], 16); error != std::errc{} || end != at + 2) {
      return std::nullopt;
    }
  }
  return ColourRange{{bytes[0], bytes[1], bytes[2]}, {bytes[3], bytes[4], bytes[5]}};
}

cv::Mat in_colours(const Still& still, const ColourRange& range) {
  cv::Mat out;
  const auto channels = [](const Colour& c, int alpha) { return cv::Scalar(c.blue, c.green, c.red, alpha); };
  cv::inRange(still.bgra, channels(range.from, 128), channels(range.to, 255), out);
  return out;
}

std::vector<std::uint8_t> on_white(const Still& still) {
  std::vector<std::uint8_t> out;
  out.reserve(3 * static_cast<std::size_t>(still.bgra.cols) * static_cast<std::size_t>(still.bgra.rows));
  for (int y = 0; y < still.bgra.rows; ++y) {
    const cv::Vec4b* row = still.bgra.ptr<cv::Vec4b>(y);
    for (int x = 0; x < still.bgra.cols; ++x) {
      const int alpha = row[x][3];
      for (const int channel : {2, 1, 0}) {
        out.push_back(static_cast<std::uint8_t>((row[x][channel] * alpha + 255 * (255 - alpha) + 127) / 255));
      }
    }
  }
  return out;
}

}  // namespace footlight::config
