// SPDX-License-Identifier: Apache-2.0
#include "app/cast_command.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <sys/resource.h>

#include "app/cast/cast_server.hpp"
#include "app/cast/follower.hpp"
#include "app/console/console.hpp"
#include "app/console/show_document.hpp"
#include "app/live/waiting.hpp"
#include "app/plan_step.hpp"
#include "app/state_folder.hpp"
#include "core/clock.hpp"

namespace footlight::app {
namespace {

constexpr Duration kLook = milliseconds(100);
constexpr Duration kReadAgain = milliseconds(10'000);  // a show file that is not yet the one that is played
constexpr std::size_t kOtherFiles = 64;                // that the process needs besides its phones

struct Options {
  PlanChoice choice;
  std::string follow;
  std::string listen = "0";
  std::vector<std::string> hosts;
  std::string desk_token;
  std::string state;
  std::size_t most_phones = 6000;
};

/// What the desk plays, told to the server. The show's files are read by the thread of the command, all else is the
/// follower's.
class Following {
 public:
  Following(CastServer& server, std::shared_ptr<const CastPlan> own) : server_(server), own_(std::move(own)) {
    server_.take_plan(own_, true);
  }

  void plan(const std::string& plan_bin, const std::string& show_hash) {
    const std::lock_guard lock(mutex_);
    plan_bin_ = plan_bin;
    wanted_ = show_hash;
    settle();
  }
  void take_own(std::shared_ptr<const CastPlan> own) {
    const std::lock_guard lock(mutex_);
    own_ = std::move(own);
    settle();
  }
  /// The files that were read are not of the show that is played.
  [[nodiscard]] bool reads_again() {
    const std::lock_guard lock(mutex_);
    return !wanted_.empty() && own_->plan().show_hash != wanted_;
  }
  void way(const std::optional<std::string>& way_bin, const DeskWord& word) {
    const std::lock_guard lock(mutex_);
    if (!way_bin || !played_) return server_.take_way(nullptr);
    const Show& show = played_->show();
    auto tracks = tracks_from(*way_bin, played_->plan().tracks.size(), played_->plan().stage.grid.size());
    if (!tracks) return say(tracks.error().message);
    const double from_s = word.way_between ? word.way_between->from_s : word.position_s;
    auto way = std::make_shared<CastWay>();
    way->counted.tempo =
        TempoMap(show.tempo.bpm_at(show.tempo.count_at(instant_at(from_s))), show.tempo.beats_per_measure());
    way->counted.performers = show.performers;
    way->tracks = std::move(tracks).value();
    server_.take_way(std::move(way));
  }
  void word(const DeskWord& word, Instant came) {
    server_.take_word(word, came);
    const std::lock_guard lock(mutex_);
    if (!std::exchange(heard_, true)) say("the desk is heard");
  }
  void lost(const std::string& why) {
    server_.lost();
    const std::lock_guard lock(mutex_);
    if (std::exchange(heard_, false) || !told_lost_)
      say("THE DESK IS NOT HEARD: " + why + "; phones say so, and it is tried again");
    told_lost_ = true;
  }
  /// What the follower has to say.
  [[nodiscard]] std::vector<std::string> said() {
    const std::lock_guard lock(mutex_);
    return std::exchange(said_, {});
  }

 private:
  void say(std::string text) { said_.push_back("cast: " + std::move(text)); }

  void settle() {
    if (wanted_.empty()) return;
    played_.reset();
    if (own_->plan().show_hash != wanted_) {
      say("the desk plays another version of the show; phones say so, and the files are read again");
      return server_.take_plan(own_, false);
    }
    constexpr std::size_t kEpoch = 8;  // bytes 8 to 11 are the desk's own
    constexpr std::size_t kTracks = 12;
    const std::string mine = plan_bytes(own_->plan(), 0);
    const bool same = mine.size() == plan_bin_.size() && mine.compare(0, kEpoch, plan_bin_, 0, kEpoch) == 0 &&
                      mine.compare(kTracks, std::string::npos, plan_bin_, kTracks, std::string::npos) == 0;
    if (same) {
      played_ = own_;
    } else if (auto tracks = tracks_from(plan_bin_, own_->plan().tracks.size(), own_->plan().stage.grid.size())) {
      say("people walk otherwise than in the files; phones show what the desk plays");
      played_ = own_->with(std::move(tracks).value());
    } else {
      say(tracks.error().message + "; phones say that they do not have it");
    }
    server_.take_plan(played_ ? played_ : own_, played_ != nullptr);
  }

  CastServer& server_;
  std::mutex mutex_;
  std::shared_ptr<const CastPlan> own_;     ///< of the files
  std::shared_ptr<const CastPlan> played_;  ///< null: unknown
  std::string plan_bin_;
  std::string wanted_;  ///< hash of the show that is played
  std::vector<std::string> said_;
  bool heard_ = false;
  bool told_lost_ = false;
};

/// As many files as the system gives. @return how many phones there is room for
std::size_t room_for(std::size_t phones) {
  rlimit files{};
  if (::getrlimit(RLIMIT_NOFILE, &files) != 0) return phones;
  files.rlim_cur = std::min<rlim_t>(files.rlim_max, phones + kOtherFiles);
  (void)::setrlimit(RLIMIT_NOFILE, &files);
  (void)::getrlimit(RLIMIT_NOFILE, &files);
  return std::min<std::size_t>(phones, files.rlim_cur > kOtherFiles ? files.rlim_cur - kOtherFiles : 1);
}

Result<std::shared_ptr<const CastPlan>> read_plan(Session& session, const PlanChoice& choice) {
  auto planned = plan_for(session, choice, false);
  if (!planned) return std::move(planned).error();
  if (auto refused = refusal_of(planned->planned)) return *std::move(refused);
  return std::make_shared<const CastPlan>(std::move(planned->loaded.show), std::move(planned->planned.plan));
}

Status<> follow(Session& session, const Options& options, CastServer& server, std::shared_ptr<const CastPlan> own,
                Follower::Settings settings, const Clock& clock) {
  Following following(server, std::move(own));
  Follower::Listener listener;
  listener.plan = [&](const std::string& bin, const std::string& hash) { following.plan(bin, hash); };
  listener.word = [&](const DeskWord& word, Instant came) { following.word(word, came); };
  listener.way = [&](const std::optional<std::string>& bin, const DeskWord& word) { following.way(bin, word); };
  listener.lost = [&](const std::string& why) { following.lost(why); };
  const Follower follower(std::move(settings), std::move(listener), clock);
  Instant read_at = clock.now();
  while (!session.stopped()) {
    for (const std::string& line : following.said()) session.note(line);
    std::this_thread::sleep_for(kLook);
    if (!following.reads_again() || clock.now() - read_at < kReadAgain) continue;
    PlanChoice again = options.choice;
    again.threads = 1;  // the show has the rest of the machine
    if (auto read = read_plan(session, again)) following.take_own(std::move(read).value());
    read_at = clock.now();
  }
  return Done{};
}

Result<std::string> read_token(const std::string& file) {
  std::ifstream in(file);
  std::string token;
  if (!(in >> token)) return input_error(fmt::format("{}: holds no token of the desk", file));
  return token;
}

int run(Session& session, const Options& options) {
  yield_to_the_show();  // and so do all threads that begin here
  auto desk = desk_place_from(options.follow);
  if (!desk) return session.fail(desk.error());
  auto place = Console::place_from(options.listen, "the cast's page");
  if (!place) return session.fail(place.error());
  Follower::Settings settings;
  settings.desk = std::move(desk).value();
  if (!options.desk_token.empty()) {
    auto token = read_token(options.desk_token);
    if (!token) return session.fail(token.error());
    settings.token = std::move(token).value();
  }
  auto own = read_plan(session, options.choice);
  if (!own) return session.fail(own.error());

  const std::filesystem::path folder = state_folder(options.state);
  std::error_code ignored;  // whoever writes there next says what is wrong
  std::filesystem::create_directories(folder, ignored);
  auto token = token_in(folder / "cast.token");
  if (!token) return session.fail(token.error());
  auto audit = AuditLog::open(folder / "cast.log");
  if (!audit) return session.fail(audit.error());
  CastServer::Settings served;
  served.address = place->address;
  served.port = place->port;
  served.hosts = options.hosts;
  served.token = token.value();
  served.most_phones = room_for(options.most_phones);
  if (served.most_phones < options.most_phones) {
    session.note(fmt::format("cast: room for {} phones alone: the system gives no more open files (ulimit -n)",
                             served.most_phones));
  }
  const SteadyClock clock;
  const std::string code = join_code(served.token);
  auto server = CastServer::open(std::move(served), audit.value().get(), clock);
  if (!server) return session.fail(server.error());
  const bool six = place->address.find(':') != std::string::npos;
  const std::string host =
      options.hosts.empty()
          ? fmt::format("{}:{}", six ? "[" + place->address + "]" : place->address, server.value()->port())
          : options.hosts.front();
  session.print_now(fmt::format("http://{}/#{}-{}", host, code.substr(0, 5), code.substr(5)));
  session.note(
      "cast: whoever has this link, or types the code behind #, sees everybody's names and ways; there is no TLS");
  const auto done = follow(session, options, *server.value(), own.value(), std::move(settings), clock);
  return done ? 0 : session.fail(done.error());
}

}  // namespace

void add_cast_command(CLI::App& program, Session& session, Chosen& chosen) {
  CLI::App* command =
      program.add_subcommand("cast", "Pages for the telephones of the cast, beside a run that it only looks at");
  auto options = std::make_shared<Options>();
  options->choice.add_options(*command);
  command
      ->add_option("--follow", options->follow,
                   "the console of the run: the address that it says, http://127.0.0.1:8440")
      ->required();
  command
      ->add_option("--listen", options->listen,
                   "a port of this machine alone, or ADDRESS:PORT for others (0: any free port)")
      ->capture_default_str();
  command->add_option("--host", options->hosts,
                      "a name by which phones reach it besides, as they write it: cast.example:9000");
  command->add_option("--desk-token", options->desk_token, "a file with a token of the console, where that wants one");
  command->add_option("--phones", options->most_phones, "at most so many at once")
      ->check(CLI::Range(1, 100'000))
      ->capture_default_str();
  command->add_option("--state", options->state, "folder for the secret of the code, and the log")
      ->default_str("~/.local/state/footlight");
  session.add_options(*command, false);
  command->footer(
      "A process of its own that listens to a run by its console and gives no orders: whatever happens to it, the "
      "show\n"
      "goes on. A performer picks her name once and sees where to stand, where to go next and a count-down; "
      "\"Where?\"\n"
      "finds her a way in when she is lost or late. Prints the link for phones on stdout: the part behind # is the "
      "code\n"
      "that everybody needs once. Remove cast.token in the state folder for a new one. SIGINT ends it.\n\n"
      "Example:\n  footlight run show.yaml --console 8440\n"
      "  footlight cast show.yaml --follow http://127.0.0.1:8440 --listen 192.168.1.5:9000\n");
  command->callback([&session, &chosen, options] { chosen = [&, options] { return run(session, *options); }; });
}

}  // namespace footlight::app
