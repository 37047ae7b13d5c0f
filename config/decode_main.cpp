// SPDX-License-Identifier: Apache-2.0
//
// footlight-decode: turns a video, an image or a text into thresholded pictures on standard output and a painting into
// colours, for config/media.cpp, or a film of lamps into the points of light of its frames, for config/lamp_film.cpp.
// Codecs are large, old and written in C; a hostile file may kill this process and nothing else. It limits itself
// before it touches the file: memory, processor time, no file may be written, few may be opened, only local files and
// listed containers are read.
#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <new>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <fcntl.h>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include "config/decode_protocol.hpp"
#include "config/decode_spots.hpp"
#include "config/decode_still.hpp"
#include "config/otsu.hpp"
#include "core/film.hpp"

namespace footlight::config {
namespace {

/// Containers as FFmpeg names them: no playlists, no concatenations, no image sequences, no devices.
constexpr const char* kCaptureOptions =
    "protocol_whitelist;file|format_whitelist;"
    "mov,mp4,m4a,3gp,3g2,mj2,matroska,webm,avi,ogg,gif,mpeg,mpegts";

struct Request {
  enum class Kind { video, image, painting, text, lamps };
  Kind kind = Kind::video;
  std::string path;   ///< of a text: the text
  std::string extra;  ///< of an image: its colours, "RRGGBBRRGGBB", or nothing; of a text: its font, or nothing
  long first = 0;
  long last = -1;       ///< -1: to the end
  long threshold = -1;  ///< -1: Otsu's; of lamps: radius of their light, in millionths of the frame's width
  bool inverted = false;
  long most_spots = 0;  ///< lamps: in a frame, in the place of `inverted`
  long max_pixels = 0;
  long max_frames = 0;
  long max_seconds = 0;
  long max_memory = 0;
};

std::optional<Request> request_from(int argc, char** argv) {
  constexpr std::array<std::string_view, 5> kKinds{"video", "image", "painting", "text", "lamps"};
  if (argc != 12) return std::nullopt;
  const auto kind = std::find(kKinds.begin(), kKinds.end(), argv[1]);
  if (kind == kKinds.end()) return std::nullopt;
  Request out;
  out.kind = static_cast<Request::Kind>(kind - kKinds.begin());
  out.path = argv[2];
  out.extra = argv[11];
  long inverted = 0;
  const std::array<long*, 8> numbers{&out.first,      &out.last,       &out.threshold,   &inverted,
                                     &out.max_pixels, &out.max_frames, &out.max_seconds, &out.max_memory};
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const std::string_view text = argv[3 + i];
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), *numbers[i]);
    if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  }
  out.inverted = inverted != 0;
  out.most_spots = inverted;
  return out;
}

bool limit(__rlimit_resource resource, long value) {
  const rlimit both{static_cast<rlim_t>(value), static_cast<rlim_t>(value)};
  return setrlimit(resource, &both) == 0;
}

/// The only way back to the parent. Libraries that chat on standard output must not reach it.
class Output {
 public:
  bool open() {
    fd_ = dup(STDOUT_FILENO);
    const int nowhere = ::open("/dev/null", O_WRONLY);
    return fd_ >= 0 && nowhere >= 0 && dup2(nowhere, STDOUT_FILENO) >= 0 && dup2(nowhere, STDERR_FILENO) >= 0;
  }
  void send(const DecodeRecord& record) const { write_all(&record, sizeof record); }
  void send(const DecodeRecord& record, const Mask& picture) const {
    send(record);
    write_all(picture.words().data(), picture.words().size() * sizeof(std::uint64_t));
  }
  void send(const DecodeRecord& record, const std::vector<std::uint8_t>& rgb) const {
    send(record);
    write_all(rgb.data(), rgb.size());
  }
  void send(const DecodeRecord& record, const std::vector<LightSpot>& spots) const {
    send(record);
    write_all(spots.data(), spots.size() * sizeof(LightSpot));
  }
  void end(DecodeStatus status, long count = 0, int width = 0, int height = 0) const {
    DecodeRecord record;
    record.status = status;
    record.count = count;
    record.width = width;
    record.height = height;
    send(record);
  }

 private:
  void write_all(const void* data, std::size_t size) const {
    const char* at = static_cast<const char*>(data);
    while (size > 0) {
      const ssize_t n = write(fd_, at, size);
      if (n < 0 && errno == EINTR) continue;
      if (n <= 0) std::_Exit(1);
      at += n;
      size -= static_cast<std::size_t>(n);
    }
  }
  int fd_ = -1;
};

void count_greys(const cv::Mat& grey, GreyHistogram& histogram) {
  for (int y = 0; y < grey.rows; ++y) {
    const std::uint8_t* row = grey.ptr<std::uint8_t>(y);
    for (int x = 0; x < grey.cols; ++x) ++histogram[row[x]];
  }
}

Mask picture_of(const cv::Mat& grey, long threshold, bool inverted) {
  Mask mask(grey.cols, grey.rows);
  std::size_t word = 0;
  for (int y = 0; y < grey.rows; ++y) {
    const std::uint8_t* row = grey.ptr<std::uint8_t>(y);
    for (int x = 0; x < grey.cols; x += 64, ++word) {
      std::uint64_t bits = 0;
      const int end = std::min(64, grey.cols - x);
      for (int i = 0; i < end; ++i) {
        bits |= static_cast<std::uint64_t>((row[x + i] > threshold) != inverted) << static_cast<unsigned>(i);
      }
      mask.words()[word] = bits;
    }
  }
  return mask;
}

/// Reads the frames of the range one after the other; seeking is not exact in many files.
class FrameReader {
 public:
  explicit FrameReader(const Request& request) : request_(request), capture_(request.path, cv::CAP_FFMPEG) {}

  bool is_open() const { return capture_.isOpened(); }
  int width() const { return static_cast<int>(capture_.get(cv::CAP_PROP_FRAME_WIDTH)); }
  int height() const { return static_cast<int>(capture_.get(cv::CAP_PROP_FRAME_HEIGHT)); }
  double fps() const { return capture_.get(cv::CAP_PROP_FPS); }
  /// Instant of the frame that was read last, as the file says it; films of telephones have no even rate.
  double time_s() const { return capture_.get(cv::CAP_PROP_POS_MSEC) * 1e-3; }
  /// Frames of the file that have been passed so far.
  long passed() const { return passed_; }
  /// Frames of the range that have been read so far.
  long taken() const { return std::max(0L, passed_ - request_.first); }

  /// The next frame's grey values, as theta is measured from them; nothing at the end of the range or of the file.
  bool read(cv::Mat& grey) {
    if (request_.last >= 0 && passed_ > request_.last) return false;
    while (passed_ < request_.first) {
      if (!capture_.grab()) return false;
      ++passed_;
    }
    if (!capture_.read(frame_) || frame_.empty()) return false;
    ++passed_;
    if (frame_.channels() == 1) {
      frame_.copyTo(grey);
    } else {
      cv::cvtColor(frame_, grey, cv::COLOR_BGR2GRAY);
    }
    return true;
  }

 private:
  const Request& request_;
  cv::VideoCapture capture_;
  cv::Mat frame_;
  long passed_ = 0;
};

/// @return what is wrong with the range once the reader has come to its end
DecodeStatus range_status(const FrameReader& reader, const Request& request) {
  const bool short_of_last = request.last >= 0 && reader.passed() <= request.last;
  if (short_of_last || (reader.passed() <= request.first && request.first > 0)) return DecodeStatus::beyond_end;
  if (reader.passed() == 0) return DecodeStatus::undecodable;
  return reader.taken() < 2 ? DecodeStatus::too_few_frames : DecodeStatus::ok;
}

bool fits(const cv::Mat& grey, int width, int height) { return grey.cols == width && grey.rows == height; }

/// Otsu's threshold over all pixels of the range; nothing when it has told the parent what is wrong.
std::optional<long> find_threshold(const Request& request, const Output& out) {
  FrameReader reader(request);
  GreyHistogram histogram{};
  cv::Mat grey;
  while (reader.read(grey)) {
    if (reader.taken() > request.max_frames) {
      out.end(DecodeStatus::too_many_frames);
      return std::nullopt;
    }
    count_greys(grey, histogram);
  }
  const DecodeStatus status = range_status(reader, request);
  if (status != DecodeStatus::ok) {
    out.end(status, status == DecodeStatus::beyond_end ? reader.passed() : reader.taken());
    return std::nullopt;
  }
  return otsu_threshold(histogram);
}

void decode_video(const Request& request, const Output& out) {
  FrameReader reader(request);
  if (!reader.is_open()) return out.end(DecodeStatus::undecodable);
  const int width = reader.width();
  const int height = reader.height();
  if (width <= 0 || height <= 0) return out.end(DecodeStatus::no_pixels, 0, std::max(0, width), std::max(0, height));
  if (static_cast<long>(width) * height > request.max_pixels) {
    return out.end(DecodeStatus::too_many_pixels, 0, width, height);
  }
  const auto threshold = request.threshold >= 0 ? std::optional<long>(request.threshold) : find_threshold(request, out);
  if (!threshold) return;
  DecodeRecord film;
  film.kind = DecodeRecord::Kind::film;
  film.width = width;
  film.height = height;
  film.fps = reader.fps();
  film.threshold = static_cast<int>(*threshold);
  out.send(film);
  DecodeRecord record;
  record.kind = DecodeRecord::Kind::frame;
  cv::Mat grey;
  while (reader.read(grey)) {
    record.count = reader.passed() - 1;
    if (!fits(grey, width, height)) return out.end(DecodeStatus::size_changes, record.count, grey.cols, grey.rows);
    if (reader.taken() > request.max_frames) return out.end(DecodeStatus::too_many_frames);
    out.send(record, picture_of(grey, *threshold, request.inverted));
  }
  const DecodeStatus status = range_status(reader, request);
  out.end(status, status == DecodeStatus::beyond_end ? reader.passed() : reader.taken());
}

void decode_lamps(const Request& request, const Output& out) {
  FrameReader reader(request);
  if (!reader.is_open()) return out.end(DecodeStatus::undecodable);
  DecodeRecord film;
  film.kind = DecodeRecord::Kind::film;
  film.width = reader.width();
  film.height = reader.height();
  film.fps = reader.fps();
  if (film.width <= 0 || film.height <= 0) {
    return out.end(DecodeStatus::no_pixels, 0, std::max(0, film.width), std::max(0, film.height));
  }
  if (static_cast<long>(film.width) * film.height > request.max_pixels) {
    return out.end(DecodeStatus::too_many_pixels, 0, film.width, film.height);
  }
  out.send(film);
  DecodeRecord record;
  record.kind = DecodeRecord::Kind::spots;
  const double radius_px = static_cast<double>(request.threshold) * 1e-6 * film.width;
  cv::Mat grey;
  while (reader.read(grey)) {
    if (!fits(grey, film.width, film.height)) {
      return out.end(DecodeStatus::size_changes, reader.passed() - 1, grey.cols, grey.rows);
    }
    if (reader.taken() > request.max_frames) return out.end(DecodeStatus::too_many_frames);
    const auto spots = find_spots(grey, radius_px, static_cast<std::size_t>(request.most_spots));
    record.count = static_cast<std::int64_t>(spots.size());
    record.fps = reader.time_s();
    out.send(record, spots);
  }
  out.end(range_status(reader, request), reader.taken());
}

/// What is said before the frame of a still.
DecodeRecord film_of(const Still& still, long threshold) {
  DecodeRecord film;
  film.kind = DecodeRecord::Kind::film;
  film.width = still.grey.cols;
  film.height = still.grey.rows;
  film.threshold = static_cast<int>(threshold);
  return film;
}

Mask still_mask(const Request& request, const Still& still, long threshold) {
  const auto colours = request.kind == Request::Kind::image ? colours_from(request.extra) : std::nullopt;
  if (!colours) return picture_of(still.grey, threshold, request.inverted);
  return picture_of(in_colours(still, *colours), 127, request.inverted);
}

void decode_still(const Request& request, const Output& out) {
  const Still still =
      request.kind == Request::Kind::text ? draw_text(request.path, request.extra) : read_still(request.path);
  if (still.status != DecodeStatus::ok) return out.end(still.status, still.detail);
  if (still.grey.empty()) return out.end(DecodeStatus::undecodable);
  if (static_cast<long>(still.grey.cols) * still.grey.rows > request.max_pixels) {
    return out.end(DecodeStatus::too_many_pixels, 0, still.grey.cols, still.grey.rows);
  }
  DecodeRecord frame;
  if (request.kind == Request::Kind::painting) {
    out.send(film_of(still, 0));
    frame.kind = DecodeRecord::Kind::painting;
    out.send(frame, on_white(still));
    return out.end(DecodeStatus::ok, 1);
  }
  long threshold = request.threshold;
  if (threshold < 0 && still.drawing) threshold = 127;
  if (threshold < 0) {
    GreyHistogram histogram{};
    count_greys(still.grey, histogram);
    threshold = otsu_threshold(histogram);
  }
  out.send(film_of(still, threshold));
  frame.kind = DecodeRecord::Kind::frame;
  out.send(frame, still_mask(request, still, threshold));
  out.end(DecodeStatus::ok, 1);
}

int run(int argc, char** argv) {
  const auto request = request_from(argc, argv);
  if (!request) {
    std::fputs("footlight-decode is started by footlight to read videos and images; it has no use of its own.\n",
               stderr);
    return 2;
  }
  Output out;
  // The parent's death must not leave a decoder behind; without these limits nothing is decoded.
  const bool bounded = out.open() && prctl(PR_SET_PDEATHSIG, SIGKILL) == 0 &&
                       prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0 && limit(RLIMIT_CORE, 0) && limit(RLIMIT_FSIZE, 0) &&
                       // Fontconfig would renew its caches: that it cannot is no reason to die.
                       signal(SIGXFSZ, SIG_IGN) != SIG_ERR && limit(RLIMIT_NOFILE, 32) &&
                       limit(RLIMIT_CPU, request->max_seconds) && limit(RLIMIT_AS, request->max_memory) &&
                       setenv("OPENCV_FFMPEG_CAPTURE_OPTIONS", kCaptureOptions, 1) == 0;
  if (!bounded) return 3;
  try {
    if (request->kind == Request::Kind::video) decode_video(*request, out);
    if (request->kind == Request::Kind::lamps) decode_lamps(*request, out);
    if (request->kind != Request::Kind::video && request->kind != Request::Kind::lamps) decode_still(*request, out);
  } catch (const std::bad_alloc&) {
    out.end(DecodeStatus::too_much_memory);
  } catch (const cv::Exception& error) {
    out.end(error.code == cv::Error::StsNoMem ? DecodeStatus::too_much_memory : DecodeStatus::undecodable);
  } catch (const std::exception&) {
    out.end(DecodeStatus::undecodable);
  }
  return 0;
}

}  // namespace
}  // namespace footlight::config

int main(int argc, char** argv) { return footlight::config::run(argc, argv); }
