// SPDX-License-Identifier: Apache-2.0
#include "app/bundle_command.hpp"

#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <system_error>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/utsname.h>
#include <sys/wait.h>
#include <unistd.h>

#include "app/load.hpp"
#include "app/plan_step.hpp"
#include "app/state_folder.hpp"
#include "app/wire_log/wire_recorder.hpp"
#include "config/output_file.hpp"

namespace footlight::app {
namespace {

struct Options {
  std::string show;
  std::string state;
  std::string output = "footlight-bundle.tar.gz";
};

/// A folder that goes with its owner.
class Staging {
 public:
  Staging() {
    std::string name = (std::filesystem::temp_directory_path() / "footlight-bundle-XXXXXX").string();
    if (mkdtemp(name.data()) != nullptr) path_ = name;
  }
  ~Staging() {
    std::error_code ignored;
    if (!path_.empty()) std::filesystem::remove_all(path_, ignored);
  }
  Staging(const Staging&) = delete;
  Staging& operator=(const Staging&) = delete;
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// What a helper asks first.
std::string versions_text() {
  utsname system{};
  (void)::uname(&system);
  std::string text = fmt::format("footlight {}\n{} {} {} {}\n", FOOTLIGHT_VERSION, system.sysname, system.release,
                                 system.version, system.machine);
  if (const auto release = config::read_file("/etc/os-release", std::size_t{1} << 16U)) text += *release;
  return text;
}

/// Sections of pcapng may follow each other: the pieces of the ring make one capture.
Status<> join(const std::vector<std::filesystem::path>& pieces, const std::filesystem::path& file) {
  std::ofstream out(file, std::ios::binary);
  for (const auto& piece : pieces) {
    std::ifstream in(piece, std::ios::binary);
    if (in.peek() != std::ifstream::traits_type::eof()) out << in.rdbuf();
  }
  out.flush();
  if (!out)
    return input_error(fmt::format("cannot write '{}': {}", file.string(), std::generic_category().message(errno)));
  return Done{};
}

/// Files that are not there are left out: a bundle is wanted most when something is missing.
void take(const std::filesystem::path& from, const std::filesystem::path& folder, std::vector<std::string>& contents) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(from, error)) return;
  std::filesystem::create_directories(folder, error);
  std::filesystem::copy_file(from, folder / from.filename(), std::filesystem::copy_options::overwrite_existing, error);
  if (!error) contents.push_back(folder.filename().string() + "/" + from.filename().string());
}

Status<> pack(const std::filesystem::path& folder, const std::string& output) {
  const std::string temporary = fmt::format("{}.{}.part", output, getpid());
  std::vector<std::string> arguments{"tar",
                                     "-czf",
                                     temporary,
                                     "-C",
                                     folder.parent_path().string(),
                                     "--owner=0",
                                     "--group=0",
                                     folder.filename().string()};
  std::vector<char*> argv;
  for (std::string& argument : arguments) argv.push_back(argument.data());
  argv.push_back(nullptr);
  pid_t pid = -1;
  int status = -1;
  const int error = posix_spawnp(&pid, "tar", nullptr, nullptr, argv.data(), environ);
  if (error != 0) return input_error("cannot start tar: " + std::generic_category().message(error));
  while (waitpid(pid, &status, 0) < 0 && errno == EINTR) {
  }
  std::error_code failed;
  if (status == 0) std::filesystem::rename(temporary, output, failed);
  if (status == 0 && !failed) return Done{};
  std::error_code ignored;
  std::filesystem::remove(temporary, ignored);
  return input_error(fmt::format("cannot write the bundle '{}'", output));
}

int run(Session& session, const Options& options) {
  const Staging staging;
  const auto folder = staging.path() / "footlight-bundle";
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (staging.path().empty() || error) return session.fail(input_error("cannot make a temporary folder"));
  std::vector<std::string> contents{"versions.txt"};
  if (auto written = config::write_file(folder / "versions.txt", versions_text()); !written) {
    return session.fail(written.error());
  }
  const auto state = state_folder(options.state);
  if (const auto pieces = ring_pieces(state / "wires"); !pieces.empty()) {
    if (auto joined = join(pieces, folder / "wires.pcapng"); !joined) return session.fail(joined.error());
    contents.emplace_back("wires.pcapng");
  } else {
    session.note(fmt::format("no wire logs in '{}' (footlight run writes them; --state names another folder)",
                             (state / "wires").string()));
  }
  for (const char* name : {"run.json", "report.json", "moments.txt"}) take(state / name, folder / "run", contents);
  if (!options.show.empty()) {
    take(options.show, folder / "show", contents);
    take(plan_file_beside(options.show), folder / "show", contents);
    const auto loaded = read_show(session, options.show);
    if (!loaded)
      session.note("the show cannot be read; its own file is packed all the same: " + loaded.error().message);
    // The media stay at home: they are large, and nothing on a wire depends on them but through the plan.
    if (loaded && !loaded->rig.file.empty()) take(loaded->rig.file, folder / "show", contents);
  }
  if (auto packed = pack(folder, options.output); !packed) return session.fail(packed.error());
  std::string text = options.output + ":";
  for (const std::string& one : contents) text += " " + one;
  session.print(text);
  return 0;
}

}  // namespace

void add_bundle_command(CLI::App& program, Session& session, Chosen& chosen) {
  CLI::App* command = program.add_subcommand("bundle", "Pack the last run's wires and reports for somebody who helps");
  auto options = std::make_shared<Options>();
  command->add_option("SHOW", options->show, "show file (YAML): it, its plan and its rig are packed, too");
  command->add_option("-o,--output", options->output, "where to write it")->capture_default_str();
  command->add_option("--state", options->state, "folder in which runs leave their traces")
      ->default_str("~/.local/state/footlight");
  session.add_options(*command, false);
  command->footer(
      "In it: wires.pcapng, the last ten minutes of every wire (Wireshark opens it), what the last run said, "
      "versions.\n"
      "Look through it before you send it: names of performers stand in show and plan.\n\n"
      "Examples:\n  footlight bundle show.yaml -o bundle.tar.gz\n");
  command->callback([&session, &chosen, options] { chosen = [&, options] { return run(session, *options); }; });
}

}  // namespace footlight::app
