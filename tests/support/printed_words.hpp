// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdlib>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/program.hpp"

namespace footlight::test {

/// What pdftotext reads of a PDF. @param option  "-layout", "-raw", "-bbox"
inline std::string text_of_pdf(const std::string& pdf, const std::string& option) {
  const TemporaryFolder folder;
  folder.write("x.pdf", pdf);
  const Ran ran = run_program({"pdftotext", option, folder / "x.pdf", folder / "x.txt"});
  EXPECT_EQ(ran.status, 0) << ran.err;
  return folder.read("x.txt");
}

/// A word on a page, in points from its upper left corner.
struct PrintedWord {
  double left, top, right, bottom;
  std::string word;
};

/// The words of each page of a PDF.
inline std::vector<std::vector<PrintedWord>> printed_words(const std::string& pdf) {
  std::vector<std::vector<PrintedWord>> out;
  std::istringstream in(text_of_pdf(pdf, "-bbox"));
  for (std::string line; std::getline(in, line);) {
    if (line.find("<page ") != std::string::npos) out.emplace_back();
    if (line.find("<word ") == std::string::npos) continue;
    const auto number = [&](const char* key) {
      return std::strtod(line.c_str() + line.find(key) + std::string(key).size(), nullptr);
    };
    const std::size_t begin = line.find("\">") + 2;
    out.back().push_back({number("xMin=\""), number("yMin=\""), number("xMax=\""), number("yMax=\""),
                          line.substr(begin, line.find("</word>") - begin)});
  }
  return out;
}

/// Fails for each pair of words that lie over each other and each word that leaves the page.
inline void expect_words_apart(const std::vector<PrintedWord>& page, double width, double height,
                               const std::string& where) {
  for (std::size_t a = 0; a < page.size(); ++a) {
    EXPECT_GE(page[a].left, 0) << page[a].word << ", " << where;
    EXPECT_GE(page[a].top, 0) << page[a].word << ", " << where;
    EXPECT_LE(page[a].right, width) << page[a].word << ", " << where;
    EXPECT_LE(page[a].bottom, height) << page[a].word << ", " << where;
    for (std::size_t b = 0; b < a; ++b) {
      const double wide = std::min(page[a].right, page[b].right) - std::max(page[a].left, page[b].left);
      const double high = std::min(page[a].bottom, page[b].bottom) - std::max(page[a].top, page[b].top);
      const double least = std::min(page[a].bottom - page[a].top, page[b].bottom - page[b].top);
      // Fonts of two scripts have lines of different heights; letters touch when they share a third of one.
      EXPECT_FALSE(wide > 1 && high > 0.4 * least) << page[a].word << " over " << page[b].word << ", " << where;
    }
  }
}

}  // namespace footlight::test
