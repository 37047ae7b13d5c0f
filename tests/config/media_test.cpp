// SPDX-License-Identifier: Apache-2.0
#include "config/media.hpp"

#include <cstdlib>
#include <string>
#include <thread>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>
#include <sys/stat.h>

#include "config/decode_protocol.hpp"
#include "core/check.hpp"
#include "tests/support/temporary_folder.hpp"

namespace footlight::config {
namespace {

using test::TemporaryFolder;

constexpr int kWidth = 80;  // not a multiple of 64: rows end inside a word
constexpr int kHeight = 48;

/// A white square that moves one pixel to the right each frame, on black.
cv::Mat drawing(int frame) {
  cv::Mat out(kHeight, kWidth, CV_8UC3, cv::Scalar(10, 10, 10));
  cv::rectangle(out, {5 + frame, 8, 24, 24}, cv::Scalar(230, 230, 230), cv::FILLED);
  return out;
}

std::string make_video(const TemporaryFolder& folder, int frames, const std::string& name = "v.avi") {
  cv::VideoWriter writer(folder / name, cv::VideoWriter::fourcc('M', 'J', 'P', 'G'), 25, {kWidth, kHeight});
  FL_CHECK(writer.isOpened());
  for (int i = 0; i < frames; ++i) writer.write(drawing(i));
  return folder / name;
}

/// The same frames as Python's check reads them: the same library, the same conversion, pixel by pixel.
std::vector<cv::Mat> greys_of(const std::string& path) {
  std::vector<cv::Mat> out;
  cv::VideoCapture capture(path);
  cv::Mat frame;
  while (capture.read(frame)) {
    cv::Mat grey;
    cv::cvtColor(frame, grey, cv::COLOR_BGR2GRAY);
    out.push_back(grey);
  }
  return out;
}

Mask mask_of(const cv::Mat& grey, int threshold, bool inverted) {
  Mask out(grey.cols, grey.rows);
  for (int y = 0; y < grey.rows; ++y) {
    for (int x = 0; x < grey.cols; ++x) {
      if (inverted ? grey.at<std::uint8_t>(y, x) <= threshold : grey.at<std::uint8_t>(y, x) > threshold) out.set(x, y);
    }
  }
  return out;
}

VideoSource video(const std::string& path, int first = 0, std::optional<int> last = std::nullopt) {
  VideoSource out;
  out.path = path;
  out.first_frame = first;
  out.last_frame = last;
  return out;
}

std::string refusal_of(const Result<Film>& film) {
  if (film.has_value()) return "a film";
  EXPECT_EQ(film.error().kind, ErrorKind::input);
  return film.error().message;
}

TEST(DecodeVideo, GivesThePixelsBrighterThanTheThreshold) {
  const TemporaryFolder folder;
  VideoSource source = video(make_video(folder, 5));
  source.picture.threshold = 100;
  const auto film = decode_video(source);
  ASSERT_TRUE(film) << film.error().message;
  const auto greys = greys_of(source.path);
  EXPECT_EQ(film->width, kWidth);
  EXPECT_EQ(film->height, kHeight);
  EXPECT_EQ(film->fps, 25);
  EXPECT_EQ(film->threshold, 100);
  EXPECT_EQ(film->first_frame, 0);
  ASSERT_EQ(film->frames.size(), 5U);
  for (std::size_t i = 0; i < greys.size(); ++i) EXPECT_EQ(film->frames[i], mask_of(greys[i], 100, false)) << i;
  EXPECT_TRUE(film->frames[3].at(10 + 3, 16));
  EXPECT_FALSE(film->frames[3].at(70, 40));
}

TEST(DecodeVideo, InvertedGivesTheDarkPixelsAndTheEqualOnes) {
  const TemporaryFolder folder;
  VideoSource source = video(make_video(folder, 3));
  source.picture.invert = true;
  source.picture.threshold = 10;  // the background's own value
  const auto film = decode_video(source);
  ASSERT_TRUE(film) << film.error().message;
  EXPECT_TRUE(film->inverted);
  const auto greys = greys_of(source.path);
  for (std::size_t i = 0; i < greys.size(); ++i) EXPECT_EQ(film->frames[i], mask_of(greys[i], 10, true)) << i;
  EXPECT_TRUE(film->frames[0].at(kWidth - 1, kHeight - 1));
}

TEST(DecodeVideo, ARangeCountsFramesOfTheFile) {
  const TemporaryFolder folder;
  VideoSource source = video(make_video(folder, 9), 3, 6);
  source.picture.threshold = 128;
  const auto film = decode_video(source);
  ASSERT_TRUE(film) << film.error().message;
  EXPECT_EQ(film->first_frame, 3);
  ASSERT_EQ(film->frames.size(), 4U);
  const auto greys = greys_of(source.path);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(film->frames[i], mask_of(greys[i + 3], 128, false)) << i;
}

TEST(DecodeVideo, WithoutAThresholdOtsusOverTheRangeDecides) {
  const TemporaryFolder folder;
  const VideoSource source = video(make_video(folder, 6), 1, 4);
  const auto film = decode_video(source);
  ASSERT_TRUE(film) << film.error().message;
  EXPECT_NEAR(film->threshold, 120, 15);
  const auto greys = greys_of(source.path);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(film->frames[i], mask_of(greys[i + 1], film->threshold, false)) << i;
  }
}

TEST(DecodeVideo, NamesWhatIsMissing) {
  EXPECT_EQ(refusal_of(decode_video(video("/nowhere/v.mp4"))),
            "cannot read '/nowhere/v.mp4': No such file or directory");
  EXPECT_EQ(refusal_of(decode_video(video("/tmp"))), "'/tmp' is not a file");
}

TEST(DecodeVideo, RefusesWhatIsNoVideo) {
  const TemporaryFolder folder;
  const std::string path = folder.write("v.mp4", "this is no video");
  const std::string expected = "'" + path +
                               "' cannot be decoded as a video (a whole file is needed: MP4, MOV, Matroska, WebM, AVI, "
                               "Ogg, GIF or MPEG, with a video stream)";
  EXPECT_EQ(refusal_of(decode_video(video(path))), expected);
  folder.write("v.mp4", "");
  EXPECT_EQ(refusal_of(decode_video(video(path))), expected);
}

TEST(DecodeVideo, RefusesPlaylistsWhateverTheirName) {
  const TemporaryFolder folder;
  make_video(folder, 4);
  folder.write("hls.mp4", "#EXTM3U\n#EXT-X-VERSION:3\n#EXT-X-TARGETDURATION:10\n#EXTINF:10,\nv.avi\n#EXT-X-ENDLIST\n");
  folder.write("concat.avi", "ffconcat version 1.0\nfile 'v.avi'\n");
  folder.write("sdp.mp4",
               "v=0\no=- 0 0 IN IP4 127.0.0.1\ns=x\nc=IN IP4 127.0.0.1\nt=0 0\nm=video 5004 RTP/AVP 96\n"
               "a=rtpmap:96 H264/90000\n");
  for (const char* name : {"hls.mp4", "concat.avi", "sdp.mp4"}) {
    EXPECT_NE(refusal_of(decode_video(video(folder / name))).find("cannot be decoded as a video"), std::string::npos)
        << name;
  }
}

TEST(DecodeVideo, ANameThatLooksLikeAProtocolOrAPatternIsAFile) {
  const TemporaryFolder folder;
  make_video(folder, 2);
  const std::string name = folder / "http:%02d.avi";
  std::filesystem::rename(folder / "v.avi", name);
  EXPECT_TRUE(decode_video(video(name)));
}

TEST(DecodeVideo, RefusesAFrameSizeOfZero) {
  const TemporaryFolder folder;
  {
    // Raw pictures: nothing but the container says how large they are.
    cv::VideoWriter writer(folder / "raw.avi", cv::CAP_FFMPEG, cv::VideoWriter::fourcc('I', '4', '2', '0'), 25,
                           {kWidth, kHeight});
    ASSERT_TRUE(writer.isOpened());
    for (int i = 0; i < 3; ++i) writer.write(drawing(i));
  }
  ASSERT_TRUE(decode_video(video(folder / "raw.avi")));
  std::string bytes = folder.read("raw.avi");
  const std::size_t strf = bytes.find("strf");
  ASSERT_NE(strf, std::string::npos);
  bytes.replace(strf + 12, 8, 8, '\0');  // width and height of the stream's bitmap header
  const std::string path = folder.write("zero.avi", bytes);
  EXPECT_EQ(refusal_of(decode_video(video(path))),
            "'" + path + "' has frames of 0 x 0 pixels (at least 1 x 1 is needed)");
}

TEST(DecodeVideo, RefusesFewerThanTwoFrames) {
  const TemporaryFolder folder;
  const std::string path = make_video(folder, 1);
  const std::string expected =
      "'" + path + "' gives 1 frame here (a video needs at least two; a single picture is an image)";
  EXPECT_EQ(refusal_of(decode_video(video(path))), expected);
  VideoSource fixed = video(path);
  fixed.picture.threshold = 100;
  EXPECT_EQ(refusal_of(decode_video(fixed)), expected);
  const std::string four = make_video(folder, 4, "four.avi");
  EXPECT_EQ(refusal_of(decode_video(video(four, 3))),
            "'" + four + "' gives 1 frame here (a video needs at least two; a single picture is an image)");
}

TEST(DecodeVideo, RefusesARangeBeyondTheEnd) {
  const TemporaryFolder folder;
  const std::string path = make_video(folder, 5);
  const std::string reach =
      "'" + path + "' has 5 frames, frames 2 to 5 reach beyond its end (frames count from 0, the last is 4)";
  EXPECT_EQ(refusal_of(decode_video(video(path, 2, 5))), reach);
  VideoSource fixed = video(path, 2, 5);
  fixed.picture.threshold = 100;
  EXPECT_EQ(refusal_of(decode_video(fixed)), reach);
  EXPECT_EQ(refusal_of(decode_video(video(path, 5))),
            "'" + path + "' has 5 frames, frame 5 is beyond its end (frames count from 0, the last is 4)");
  EXPECT_EQ(refusal_of(decode_video(video(path, 4, 4))),
            "frames 4 to 4 are no range (the first is at least 0, the last comes after it)");
}

TEST(DecodeVideo, KeepsItsLimits) {
  const TemporaryFolder folder;
  const std::string path = make_video(folder, 5);
  MediaLimits few_pixels;
  few_pixels.max_pixels = 1000;
  EXPECT_EQ(refusal_of(decode_video(video(path), few_pixels)),
            "'" + path + "' has frames of 80 x 48 pixels (at most 1000 pixels are allowed)");
  MediaLimits few_frames;
  few_frames.max_frames = 4;
  const std::string many = "'" + path + "' gives more than 4 frames (choose a shorter range)";
  EXPECT_EQ(refusal_of(decode_video(video(path), few_frames)), many);
  VideoSource fixed = video(path);
  fixed.picture.threshold = 100;
  EXPECT_EQ(refusal_of(decode_video(fixed, few_frames)), many);
  few_frames.max_frames = 5;
  EXPECT_TRUE(decode_video(fixed, few_frames));
}

TEST(DecodeVideo, StopsWhenToldTo) {
  const TemporaryFolder folder;
  const std::atomic<bool> stop = true;
  const auto film = decode_video(video(make_video(folder, 5)), {}, &stop);
  ASSERT_FALSE(film);
  EXPECT_EQ(film.error(), (Error{ErrorKind::interrupted, "interrupted while decoding '" + folder / "v.avi" + "'"}));
}

TEST(DecodeImage, GivesOneFrame) {
  const TemporaryFolder folder;
  const cv::Mat grey = drawing(0);
  for (const std::string name : {"i.png", "i.bmp", "i.pgm", "i.jpg"}) {
    cv::Mat one;
    cv::cvtColor(grey, one, cv::COLOR_BGR2GRAY);
    cv::imwrite(folder / name, one);
    const auto film = decode_image({folder / name, {}});
    ASSERT_TRUE(film) << film.error().message;
    EXPECT_EQ(film->fps, 0);
    ASSERT_EQ(film->frames.size(), 1U);
    EXPECT_EQ(film->frames[0], mask_of(one, 120, false)) << name;
  }
}

TEST(DecodeImage, WhatIsTransparentIsDark) {
  const TemporaryFolder folder;
  cv::Mat image(4, 6, CV_8UC4, cv::Scalar(255, 255, 255, 0));
  image.at<cv::Vec4b>(1, 2) = {255, 255, 255, 255};
  image.at<cv::Vec4b>(2, 3) = {255, 255, 255, 128};
  cv::imwrite(folder / "a.png", image);
  ImageSource source{folder / "a.png", {}};
  source.picture.threshold = 127;
  const auto film = decode_image(source);
  ASSERT_TRUE(film) << film.error().message;
  Mask expected(6, 4);
  expected.set(2, 1);
  expected.set(3, 2);  // 128 of 255
  EXPECT_EQ(film->frames[0], expected);
}

TEST(DecodeImage, SixteenBitsAreTakenAsEight) {
  const TemporaryFolder folder;
  cv::Mat image(3, 3, CV_16UC1, cv::Scalar(100 * 257));
  image.at<std::uint16_t>(1, 1) = 101 * 257;
  cv::imwrite(folder / "a.png", image);
  ImageSource source{folder / "a.png", {}};
  source.picture.threshold = 100;
  const auto film = decode_image(source);
  ASSERT_TRUE(film) << film.error().message;
  Mask expected(3, 3);
  expected.set(1, 1);
  EXPECT_EQ(film->frames[0], expected);
}

TEST(DecodeImage, RefusesWhatIsNoImageOfTheListedKinds) {
  const TemporaryFolder folder;
  const auto expected = [&](const std::string& path) {
    return "'" + path +
           "' cannot be decoded as an image (a whole file is needed: PNG, JPEG, BMP, PBM, PGM or SVG, of 1 to "
           "16777216 pixels)";
  };
  cv::imwrite(folder / "a.tiff", drawing(0));
  std::filesystem::rename(folder / "a.tiff", folder / "a.png");
  EXPECT_EQ(refusal_of(decode_image({folder / "a.png", {}})), expected(folder / "a.png"));
  const std::string empty = folder.write("zero.pgm", "P5\n0 0\n255\n");
  EXPECT_EQ(refusal_of(decode_image({empty, {}})), expected(empty));
  cv::imwrite(folder / "cut.png", drawing(0));
  const std::string cut = folder.write("cut.png", folder.read("cut.png").substr(0, 60));
  EXPECT_EQ(refusal_of(decode_image({cut, {}})), expected(cut));
}

// A decoder that is another program than ours. Each says what a hostile file could make ours say, or dies.

class HostileDecoder : public ::testing::Test {
 protected:
  ~HostileDecoder() override { unsetenv("FOOTLIGHT_DECODER"); }

  void runs(const std::string& script) {
    const std::string path = folder_.write("decoder", "#!/bin/sh\n" + script + "\n");
    chmod(path.c_str(), 0700);
    setenv("FOOTLIGHT_DECODER", path.c_str(), 1);
  }
  /// The decoder sends these bytes.
  void says(const std::string& bytes) {
    folder_.write("said", bytes);
    runs("cat " + folder_ / "said");
  }
  static std::string bytes_of(const DecodeRecord& record) {
    return {reinterpret_cast<const char*>(&record), sizeof record};
  }
  static DecodeRecord film() {
    DecodeRecord out;
    out.kind = DecodeRecord::Kind::film;
    out.width = 10;
    out.height = 2;
    out.threshold = 128;
    out.fps = 25;
    return out;
  }
  static std::string frame(int number, char pixels = '\x01') {
    DecodeRecord out;
    out.kind = DecodeRecord::Kind::frame;
    out.count = number;
    std::string picture(16, '\0');
    picture[0] = pixels;
    return bytes_of(out) + picture;
  }
  static std::string end(int frames) {
    DecodeRecord out;
    out.count = frames;
    return bytes_of(out);
  }
  std::string refusal(const MediaLimits& limits = {}) { return refusal_of(decode_video(video(file_), limits)); }
  std::string nonsense(const std::string& what) {
    return "decoding '" + file_ + "' gave no usable film: " + what +
           " (footlight and footlight-decode must be of one version and the file whole)";
  }

  TemporaryFolder folder_;
  std::string file_ = folder_.write("v.mp4", "x");
};

TEST_F(HostileDecoder, AWellFormedAnswerIsTaken) {
  says(bytes_of(film()) + frame(0) + frame(1) + end(2));
  const auto decoded = decode_video(video(file_));
  ASSERT_TRUE(decoded) << decoded.error().message;
  EXPECT_TRUE(decoded->frames[1].at(0, 0));
}

TEST_F(HostileDecoder, GarbageIsRefused) {
  says(std::string(100'000, 'Z'));
  EXPECT_EQ(refusal(), nonsense("it does not begin as it should"));
}

TEST_F(HostileDecoder, ASizeOutOfRangeIsRefusedBeforeMemoryIsTaken) {
  for (const auto& [width, height] : {std::pair{0, 4}, {4, 0}, {-1, -1}, {1 << 30, 1 << 30}, {4097, 4096}}) {
    DecodeRecord huge = film();
    huge.width = width;
    huge.height = height;
    says(bytes_of(huge));
    EXPECT_EQ(refusal(), nonsense("its frame size is out of range")) << width << " x " << height;
  }
}

TEST_F(HostileDecoder, AnotherThresholdThanAskedForIsRefused) {
  DecodeRecord wrong = film();
  wrong.threshold = 256;
  says(bytes_of(wrong));
  EXPECT_EQ(refusal(), nonsense("its threshold is not the one asked for"));
}

TEST_F(HostileDecoder, FramesOutOfOrderOrWithPixelsOutsideAreRefused) {
  says(bytes_of(film()) + frame(0) + frame(2) + end(2));
  EXPECT_EQ(refusal(), nonsense("a frame is out of order"));
  std::string outside = frame(0);
  outside[outside.size() - 7] = '\x04';  // row 1, pixel 10
  says(bytes_of(film()) + outside + frame(1) + end(2));
  EXPECT_EQ(refusal(), nonsense("a frame has pixels outside of itself"));
}

TEST_F(HostileDecoder, AnAnswerCutOffAnywhereIsRefused) {
  const std::string whole = bytes_of(film()) + frame(0) + frame(1) + end(2);
  for (std::size_t size = 0; size < whole.size(); size += 7) {
    says(whole.substr(0, size));
    EXPECT_EQ(refusal(), nonsense("it ends too early")) << size;
  }
  says(bytes_of(film()) + frame(0) + end(1));
  EXPECT_EQ(refusal(), nonsense("frames are missing"));
  says(bytes_of(film()) + frame(0) + frame(1) + end(3));
  EXPECT_EQ(refusal(), nonsense("it does not end as it should"));
  says(whole + "x");
  EXPECT_EQ(refusal(), nonsense("something follows its end"));
}

TEST_F(HostileDecoder, FramesWithoutEndAreCutAtTheLimits) {
  says(bytes_of(film()) + frame(0) + frame(1) + frame(2) + end(3));
  MediaLimits limits;
  limits.max_frames = 2;
  EXPECT_EQ(refusal(limits), nonsense("a frame is out of order"));
  limits = {};
  limits.max_memory_bytes = 40;
  EXPECT_EQ(refusal(limits),
            "'" + file_ + "' needs more than 0 MiB for its frames (choose a shorter range or a smaller frame size)");
}

TEST_F(HostileDecoder, ItsDeathIsOneClearMessage) {
  runs("kill -SEGV $$");
  EXPECT_EQ(refusal(),
            "decoding '" + file_ +
                "' ended by signal 11 (Segmentation fault) (the file is broken, or needs more than 2048 MiB)");
  runs("kill -XCPU $$");
  EXPECT_EQ(refusal(),
            "'" + file_ + "' takes more than 600 s to decode (a shorter range or a smaller frame size would do)");
  runs("exit 3");
  EXPECT_EQ(refusal(),
            "decoding '" + file_ + "' ended with status 3 (the file is broken, or needs more than 2048 MiB)");
}

TEST_F(HostileDecoder, SilenceIsEnded) {
  runs("exec sleep 1000");
  MediaLimits limits;
  limits.max_seconds = 0.05;
  EXPECT_EQ(refusal(limits),
            "'" + file_ + "' takes more than 0.1 s to decode (a shorter range or a smaller frame size would do)");
}

TEST_F(HostileDecoder, AnInterruptionEndsTheWait) {
  runs("exec sleep 1000");
  std::atomic<bool> stop = false;
  std::thread user([&] { stop = true; });
  const auto decoded = decode_video(video(file_), {}, &stop);
  user.join();
  ASSERT_FALSE(decoded);
  EXPECT_EQ(decoded.error().kind, ErrorKind::interrupted);
}

TEST_F(HostileDecoder, AMissingProgramIsNamed) {
  setenv("FOOTLIGHT_DECODER", "/nowhere/footlight-decode", 1);
  const auto decoded = decode_video(video(file_));
  ASSERT_FALSE(decoded);
  EXPECT_EQ(decoded.error(), internal_error("cannot find the program footlight-decode, which reads videos and images "
                                            "(looked for /nowhere/footlight-decode; FOOTLIGHT_DECODER may name it)"));
}

}  // namespace
}  // namespace footlight::config
