// SPDX-License-Identifier: Apache-2.0
#include "app/sound/voice.hpp"

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include "app/sound/sound_file.hpp"

namespace footlight::app {
namespace {

constexpr const char* kProgram = "espeak-ng";
constexpr double kLongest_s = 0.6;

/// @return its exit status; nothing: it could not be run, or was ended
std::optional<int> run(std::vector<std::string> words) {
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  for (const int file : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    posix_spawn_file_actions_addopen(&actions, file, "/dev/null", file == STDIN_FILENO ? 0 : 1, 0);
  }
  pid_t child = -1;
  const int error = ::posix_spawnp(&child, kProgram, &actions, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (error != 0) return std::nullopt;
  for (int waited_ms = 0; waited_ms < 5000; waited_ms += 5) {
    int status = 0;
    if (::waitpid(child, &status, WNOHANG) == child) {
      return WIFEXITED(status) ? std::optional(WEXITSTATUS(status)) : std::nullopt;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  ::kill(child, SIGKILL);
  (void)::waitpid(child, nullptr, 0);
  return std::nullopt;
}

/// A folder for what it says, gone at the end.
class Folder {
 public:
  Folder() {
    std::string name = (std::filesystem::temp_directory_path() / "footlight-voice-XXXXXX").string();
    if (::mkdtemp(name.data()) != nullptr) path_ = name;
  }
  ~Folder() {
    std::error_code ignored;
    if (!path_.empty()) std::filesystem::remove_all(path_, ignored);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  [[nodiscard]] std::string operator/(const std::string& name) const { return (path_ / name).string(); }

 private:
  std::filesystem::path path_;
};

}  // namespace

Result<Voice> speak_numbers(const std::string& language) {
  const Folder folder;
  Voice voice;
  for (int number = 1; number <= 8; ++number) {
    const std::string file = folder / fmt::format("{}.wav", number);
    const auto status = run({kProgram, "-v", language, "-s", "220", "-w", file, std::to_string(number)});
    // posix_spawn and the shell both say 127 of a program that is not there.
    if (!status || *status == 127) {
      return device_error("espeak-ng is not installed: the count-in is clicked and not spoken (apt install espeak-ng)");
    }
    if (*status != 0)
      return device_error(
          fmt::format("espeak-ng does not speak \"{}\": the count-in is clicked and not spoken", language));
    auto sound = SoundFile::read(file);
    if (!sound) return device_error("what espeak-ng says cannot be used: " + sound.error().message);
    voice.numbers[static_cast<std::size_t>(number)] = std::make_shared<const Samples>(trimmed(*sound, kLongest_s));
  }
  return voice;
}

}  // namespace footlight::app
