// SPDX-License-Identifier: Apache-2.0
#include "app/painting_command.hpp"

#include <memory>
#include <string>
#include <utility>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "app/find_in_show.hpp"
#include "app/load.hpp"
#include "app/output_place.hpp"
#include "app/painting_report.hpp"
#include "app/paper/painting_overlay.hpp"
#include "config/output_file.hpp"
#include "planner/painted/section_scene.hpp"
#include "planner/painted/walls.hpp"

namespace footlight::app {
namespace {

struct Options {
  std::string show;
  std::string section;
  std::string output;
};

int run(Session& session, const Options& options) {
  const bool svg = options.output.ends_with(".svg");
  if (!options.output.empty()) {
    if (!svg && !options.output.ends_with(".png")) {
      return session.fail(input_error(
          fmt::format("'{}': a painting is drawn into a file that ends with .svg or .png", options.output)));
    }
    if (auto free = can_write(options.output); !free) return session.fail(free.error());
  }
  auto loaded = read_show(session, options.show);
  if (!loaded) return session.fail(loaded.error());
  if (!options.output.empty()) {
    if (auto spared = spare_inputs(*loaded, options.output); !spared) return session.fail(spared.error());
  }
  const auto section = find_painting(loaded->show, options.section);
  if (!section) return session.fail(section.error());
  const auto films = decode_films(session, *loaded);
  if (!films) return session.fail(films.error());
  const auto scene = planner::section_scene(loaded->show, *section, *films, session.progress());
  if (!scene) return session.fail(scene.error());
  if (!options.output.empty()) {
    const planner::RgbPicture picture = planner::picture_of(*(*films)[section->at()]);
    const std::string drawn = painting_overlay({&loaded->show, *section, &*scene, picture}, svg);
    if (auto done = config::write_file(options.output, drawn); !done) return session.fail(done.error());
  }
  session.clear_line();
  for (const std::string& note : scene->notes) session.note(note);
  session.print(session.json ? painting_json(loaded->show, *section, *scene, options.output)
                             : painting_text(loaded->show, *section, *scene, options.output));
  return 0;
}

}  // namespace

void add_painting_command(CLI::App& program, Session& session, Chosen& chosen) {
  CLI::App* command = program.add_subcommand("painting", "Tell and draw what was understood of a painting");
  auto options = std::make_shared<Options>();
  command->add_option("SHOW", options->show, "the show file")->required();
  command->add_option("SECTION", options->section, "the section that follows it (default: the only one)");
  command->add_option("-o,--output", options->output, "draw it over the painting, too: FILE.svg or FILE.png");
  session.add_options(*command, true);
  command->footer(
      "Nothing is planned: it is quick enough to ask after each stroke of the brush.\n\n"
      "Examples:\n  footlight painting show.yaml\n  footlight painting show.yaml exit -o exit.svg\n"
      "  footlight painting show.yaml --json | jq '.parties[].legs[].strokes[].width_m'\n");
  command->callback([&session, &chosen, options] { chosen = [&, options] { return run(session, *options); }; });
}

}  // namespace footlight::app
