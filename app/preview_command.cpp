// SPDX-License-Identifier: Apache-2.0
#include "app/preview_command.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include "app/find_in_show.hpp"
#include "app/output_place.hpp"
#include "app/paper/preview.hpp"
#include "app/plan_step.hpp"
#include "app/planar_frame.hpp"
#include "app/video_writer.hpp"
#include "app/written.hpp"
#include "config/output_file.hpp"

namespace footlight::app {
namespace {

constexpr int kSmallestSide = 64;
constexpr int kLargestSide = 7680;
/// Frames that are drawn at once, each on a canvas of its own.
constexpr std::size_t kAtOnce = 8;

struct Options {
  PlanChoice choice;
  std::string output;
  std::string view = "above";
  std::string size = "1280x720";
  std::string formation;
  std::optional<double> at;
  std::optional<double> from;
  std::optional<double> to;
  double rate = 25;
  bool film = false;
  bool sheet = false;
};

struct Size {
  int width = 0;
  int height = 0;
};

Result<Size> size_of(const std::string& text) {
  Size out;
  char after = 0;
  const bool read = std::sscanf(text.c_str(), "%5dx%5d%c", &out.width, &out.height, &after) == 2;
  const auto fits = [](int side) { return side >= kSmallestSide && side <= kLargestSide; };
  if (read && fits(out.width) && fits(out.height)) return out;
  return input_error(fmt::format("--size: \"{}\" is no size (WIDTHxHEIGHT as 1280x720, each {} to {})", text,
                                 kSmallestSide, kLargestSide));
}

/// What is drawn, and of when.
struct Scene {
  const Plan& plan;
  const Show& show;
  Stamp stamp;
  std::vector<const Film*> films;
  PreviewStyle style;
  Size size;
  Instant first;
  Instant last;
};

Result<Instant> still_of(const Plan& plan, const Show& show, const Options& options) {
  if (!options.formation.empty()) {
    auto found = find_formation(plan, options.formation);
    if (!found) return input_error("--formation: " + found.error().message);
    return plan.formations[found->at()].time;
  }
  if (options.at) return show.tempo.at(*options.at);
  return plan.sections.front().start;
}

/// The range of a film: the whole show, or what is asked for of it.
Status<> set_range(Scene& scene, const Options& options) {
  scene.first = scene.plan.sections.front().start;
  scene.last = scene.plan.sections.back().end;
  const auto count = [&](Instant at) { return fmt::format("{:g}", scene.show.tempo.count_at(at)); };
  const Instant first = options.from ? std::max(scene.first, scene.show.tempo.at(*options.from)) : scene.first;
  const Instant last = options.to ? std::min(scene.last, scene.show.tempo.at(*options.to)) : scene.last;
  if (first > last) {
    return input_error(
        fmt::format("nothing of the show is in the range of --from and --to (it goes from count {} to count {})",
                    count(scene.first), count(scene.last)));
  }
  scene.first = first;
  scene.last = last;
  return Done{};
}

std::size_t frames_of(const Scene& scene, double rate) {
  return static_cast<std::size_t>(std::floor(to_seconds(scene.last - scene.first) * rate + 1e-9)) + 1;
}

/// Frames that are drawn, and then encoded while the next are drawn.
using Block = std::vector<std::vector<unsigned char>>;

Status<> write_block(VideoWriter& writer, const Block& block) {
  for (const auto& frame : block) {
    if (auto done = writer.write(frame); !done) return done;
  }
  return Done{};
}

Status<> film(Session& session, const Scene& scene, const Options& options) {
  const auto [width, height] = scene.size;
  const PreviewFrame frame(scene.plan, scene.show, scene.stamp, scene.films, scene.style, width, height);
  auto writer = VideoWriter::open(options.output, {width, height, options.rate, scene.stamp.title, scene.stamp.line()});
  if (!writer) return std::move(writer).error();
  const auto blank = [&] { return Canvas::png(scene.size.width, scene.size.height, kOnScreen.ground); };
  std::vector<Canvas> still;
  for (std::size_t s = 0; s < scene.plan.sections.size(); ++s) {
    still.push_back(blank());
    frame.draw_still(still.back(), SectionIndex::of(s));
  }
  // A canvas belongs to the thread that made it: Pango's fonts are one thread's.
  tbb::enumerable_thread_specific<Canvas> canvases(blank);
  Block drawn;
  Block encoded;
  std::future<Status<>> writing;
  const std::size_t frames = frames_of(scene, options.rate);
  for (std::size_t begin = 0; begin < frames; begin += kAtOnce) {
    if (session.stopped()) return Error{ErrorKind::interrupted, "interrupted while filming; nothing was written"};
    session.tell("filming", static_cast<double>(begin) / static_cast<double>(frames));
    const std::size_t end = std::min(begin + kAtOnce, frames);
    drawn.resize(end - begin);
    tbb::parallel_for(begin, end, [&](std::size_t k) {
      const Instant at = scene.first + seconds(static_cast<double>(k) / options.rate);
      Canvas& canvas = canvases.local();
      canvas.copy(still[frame.preview().section_of(at).at()]);
      frame.draw_moving(canvas, at);
      to_planar(canvas.pixels(), scene.size.width, scene.size.height, drawn[k - begin]);
    });
    if (writing.valid()) {
      if (auto done = writing.get(); !done) return done;
    }
    std::swap(drawn, encoded);
    writing = std::async(std::launch::async, [&] { return write_block(*writer, encoded); });
  }
  if (auto done = writing.get(); !done) return done;
  return writer->finish();
}

std::string picture(const Scene& scene, const Options& options) {
  const double width = scene.size.width;
  const double height = scene.size.height;
  Canvas canvas = options.output.ends_with(".svg") ? Canvas::svg(width, height)
                                                   : Canvas::png(scene.size.width, scene.size.height, kOnScreen.ground);
  if (options.sheet) {
    draw_contact_sheet(canvas, scene.plan, scene.show, scene.stamp, scene.films, scene.style);
  } else {
    const PreviewFrame frame(scene.plan, scene.show, scene.stamp, scene.films, scene.style, width, height);
    frame.draw_still(canvas, frame.preview().section_of(scene.first));
    frame.draw_moving(canvas, scene.first);
  }
  return canvas.finish();
}

/// What the command line alone has wrong.
Status<> check(const Options& options, const Size& size, bool video) {
  if (!video && !options.output.ends_with(".png") && !options.output.ends_with(".svg")) {
    return input_error(fmt::format("'{}': a preview is a file that ends with .mp4, .png or .svg", options.output));
  }
  if (video && (size.width % 2 != 0 || size.height % 2 != 0)) {
    return input_error(
        fmt::format("--size: {}x{} is odd (a film's width and height are even)", size.width, size.height));
  }
  if (video && (options.sheet || options.at || !options.formation.empty())) {
    return input_error(
        "--at, --formation and --contact-sheet are for pictures (.png, .svg), --from and --to for films");
  }
  if (!video && (options.from || options.to)) {
    return input_error("--from and --to are for films (.mp4); a picture shows one moment: --at or --formation");
  }
  if ((options.at ? 1 : 0) + (options.formation.empty() ? 0 : 1) + (options.sheet ? 1 : 0) > 1) {
    return input_error("a picture shows one of --at, --formation and --contact-sheet");
  }
  return can_write(options.output);
}

int run(Session& session, const Options& options) {
  const bool video = options.output.ends_with(".mp4");
  const auto size = size_of(options.size);
  if (!size) return session.fail(size.error());
  if (auto right = check(options, *size, video); !right) return session.fail(right.error());
  auto planned = plan_for(session, options.choice, options.film);
  if (!planned) return session.fail(planned.error());
  if (auto spared = spare_inputs(planned->loaded, options.output); !spared) return session.fail(spared.error());
  const Plan& plan = planned->plan();
  Scene scene{plan, planned->loaded.show, Stamp(plan), {}, {}, *size, {}, {}};
  scene.style = {options.view == "audience" ? Seat::audience : Seat::above, options.film};
  if (options.film) {
    for (const auto& one : *planned->films) scene.films.push_back(one ? &*one : nullptr);
  }
  if (video) {
    if (auto done = set_range(scene, options); !done) return session.fail(done.error());
    if (auto done = film(session, scene, options); !done) return session.fail(done.error());
  } else {
    const auto moment = still_of(plan, scene.show, options);
    if (!moment) return session.fail(moment.error());
    scene.first = *moment;
    if (auto done = config::write_file(options.output, picture(scene, options)); !done)
      return session.fail(done.error());
  }
  session.clear_line();
  if (session.json) {
    auto out = written_json(scene.stamp, {options.output});
    out.update({{"view", options.view}, {"width", size->width}, {"height", size->height}});
    if (video) {
      out.update({{"rate", options.rate},
                  {"frames", frames_of(scene, options.rate)},
                  {"from_s", to_seconds(scene.first)},
                  {"to_s", to_seconds(scene.last)}});
    } else if (!options.sheet) {
      out["at_s"] = to_seconds(scene.first);
    }
    session.print(out.dump(2));
  } else {
    session.print(fmt::format("{}: plan {}", options.output, scene.stamp.plan));
  }
  // A preview of a refused plan helps to see why; it says so itself.
  const auto refused = refusal_of(planned->planned);
  return refused ? session.fail(*refused) : 0;
}

}  // namespace

void add_preview_command(CLI::App& program, Session& session, Chosen& chosen) {
  CLI::App* command = program.add_subcommand("preview", "Show the stage as a film or a picture");
  auto options = std::make_shared<Options>();
  options->choice.add_options(*command);
  command->add_option("-o,--output", options->output, "FILE.mp4, FILE.png or FILE.svg")->required();
  command->add_option("--view", options->view, "above, or audience (in perspective)")
      ->check(CLI::IsMember({"above", "audience"}));
  command->add_flag("--film", options->film, "what the show's film shows, and who is outside of it in vermilion");
  command->add_option("--size", options->size, "pixels of a film or PNG, points of an SVG (default: 1280x720)");
  command->add_option("--rate", options->rate, "frames a second of a film (default: 25)")
      ->check(CLI::Range(1.0, 120.0));
  command->add_option("--from", options->from, "count with which a film begins")->check(CLI::Range(-1e9, 1e9));
  command->add_option("--to", options->to, "count with which a film ends")->check(CLI::Range(-1e9, 1e9));
  command->add_option("--at", options->at, "count of a picture (default: the show's first)")
      ->check(CLI::Range(-1e9, 1e9));
  command->add_option("--formation", options->formation, "the formation of a picture, as growth/12");
  command->add_flag("--contact-sheet", options->sheet, "all key formations in one picture");
  session.add_options(*command, true);
  command->footer(
      "Films are made by the program ffmpeg.\n\n"
      "Examples:\n  footlight preview show.yaml -o show.mp4\n"
      "  footlight preview show.yaml -o seat.mp4 --view audience --from 25 --to 57 --size 1920x1080 --rate 50\n"
      "  footlight preview show.yaml -o film.mp4 --film\n"
      "  footlight preview show.yaml -o sheet.svg --contact-sheet\n");
  command->callback([&session, &chosen, options] { chosen = [&, options] { return run(session, *options); }; });
}

}  // namespace footlight::app
