// SPDX-License-Identifier: Apache-2.0
#include "coupling/channel.h"

#include <fmt/format.h>
#include <sys/prctl.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <optional>

#include "common/app/guarded.h"
#include "common/app/log.h"
#include "common/parallel/watchdog.h"
#include "coupling/large_pages.h"
#include "coupling/messages.h"
#include "coupling/notice.h"
#include "coupling/polite.h"
#include "coupling/stand_in.h"

namespace bw::coupling {
namespace {

const char* word_of(int tag) {
  switch (tag) {
    case tag_hello:
      return "HELLO";
    case tag_step:
      return "STEP";
    case tag_load:
      return "LOAD";
    case tag_bye:
      return "BYE";
    default:
      return tag >= tag_x && tag <= tag_faces ? "SURFACE" : "LOAD";
  }
}

constexpr double last_words = 0.5;  // s that messages of a program that has ended may be under way

const Lifeline* watched = nullptr;  // while messages are on their way
bool is_watched_cut() { return watched && watched->is_cut(); }

std::atomic<bool> ending{false};  // a failure is being told: what happens meanwhile changes nothing

}  // namespace

const char* name_of(Role role) { return role == Role::solid ? "solid" : "fluid"; }

struct Channel::State : std::enable_shared_from_this<Channel::State> {
  Comm mine;
  MPI_Comm inter = MPI_COMM_NULL;
  Role role = Role::solid;
  std::string peer = "the other program";
  ChannelLimits limits;
  int64_t window = -1;
  double t = 0, waited = 0;
  bool open = true;
  std::vector<MPI_Request> started;
  bool rung = false;                  // since the last of them
  std::unique_ptr<StandIn> stand_in;  // then there is no inter
  std::unique_ptr<Bell> bell;         // with inter
  LargePages large_pages;
  std::unique_ptr<Lifeline> line;
  std::optional<Patience> cut;  // since when the line is

  static std::shared_ptr<State> active;  // survives the Channel while an exception is on its way to be reported

  std::string place() const { return window < 0 ? "" : fmt::format(" in window {} at t = {:.6g} s", window, t); }
  /// said: the text is on the screen already
  [[noreturn]] void end(int code, const std::string& text, bool said = false);
  [[noreturn]] void end_with_peer(int source);
  /// may_be_there: false: no message has come
  void look_for_failure(bool may_be_there = true);
  void become_active();
  void watch_silence() const;
  bool is_anything_there() const;
  bool is_there(int tag) const;
  static void at_exit();
  [[noreturn]] static void at_terminate();
};

std::shared_ptr<Channel::State> Channel::State::active;

/// The leaders see each wait to its end. From one place to the next a healthy run waits at most for a file, for loads
/// and, on the other side, for this one's steps: what takes longer are leaders that hang themselves.
void Channel::State::watch_silence() const {
  if (inter == MPI_COMM_NULL) return;
  watch(3 * limits.silence + 5, exit_silence,
        fmt::format("no window has ended within three times the silence limit of {:g} s{}: processes of this run hang",
                    limits.silence, place()));
}

// --- failing
// ------------------------------------------------------------------------------------------------------------------

void Channel::State::end(int code, const std::string& text, bool said) {
  if (code == 0) code = exit_unspecified;
  if (ending.exchange(true)) _exit(code);  // failed while failing
  quiet_notice();
  if (!said) error_line(fmt::format("FAILED{}: {} [exit code {}]", place(), text, code));
  std::fflush(nullptr);
  stand_in.reset();  // its file is closed before the libraries end
  int main_thread = 0;
  if (MPI_Is_thread_main(&main_thread) != MPI_SUCCESS || !main_thread) _exit(code);  // mpirun then ends the others
  if (open && inter != MPI_COMM_NULL) {
    open = false;
    FailBlock fail{};
    fail.code = code;
    fail.rank = mine.rank();
    fail.window = window;
    fail.t = t;
    std::snprintf(fail.text, sizeof fail.text, "%s", text.c_str());
    MPI_Request request;
    MPI_Isend(&fail, sizeof fail, MPI_BYTE, 0, tag_fail, inter, &request);
    if (bell) bell->ring();
    const Patience patience;
    int heard = 0;
    while (!heard && patience.seconds() < limits.acknowledge) {
      MPI_Iprobe(0, tag_ack, inter, &heard, MPI_STATUS_IGNORE);
      if (!heard) MPI_Iprobe(MPI_ANY_SOURCE, tag_fail, inter, &heard, MPI_STATUS_IGNORE);  // a crossing FAIL is as good
      if (!heard) patience.rest();
    }
    if (!heard) error_line(fmt::format("{} did not answer within {:g} s; ending it", peer, limits.acknowledge));
  }
  MPI_Abort(MPI_COMM_WORLD, code);
  _exit(code);
}

void Channel::State::end_with_peer(int source) {
  ending = true;
  open = false;
  FailBlock fail{};
  MPI_Recv(&fail, sizeof fail, MPI_BYTE, source, tag_fail, inter, MPI_STATUS_IGNORE);
  fail.text[sizeof fail.text - 1] = 0;
  quiet_notice();
  error_line(fmt::format("{} (rank {}) FAILED{}: {}; ending too [exit code {}]", peer, fail.rank,
                         fail.window < 0 ? "" : fmt::format(" in window {} at t = {:.6g} s", fail.window, fail.t),
                         fail.text, fail.code));
  std::fflush(nullptr);
  MPI_Request request;
  MPI_Isend(nullptr, 0, MPI_BYTE, source, tag_ack, inter, &request);
  const Patience patience;  // the one that failed ends the job; if it cannot, this one does
  int sent = 0;
  while (patience.seconds() < limits.acknowledge && !(sent && line)) {  // by a port its job is another
    if (!sent) MPI_Test(&request, &sent, MPI_STATUS_IGNORE);
    patience.rest();
  }
  const int code = fail.code == 0 ? int(exit_unspecified) : fail.code;
  MPI_Abort(MPI_COMM_WORLD, code);
  _exit(code);
}

void Channel::State::look_for_failure(bool may_be_there) {
  if (!open || ending || inter == MPI_COMM_NULL) return;
  int there = 0;
  MPI_Status status;
  if (may_be_there) check_mpi(MPI_Iprobe(MPI_ANY_SOURCE, tag_fail, inter, &there, &status), "MPI_Iprobe");
  if (there) end_with_peer(status.MPI_SOURCE);
  if (line && !cut && line->is_cut()) cut.emplace();
  if (cut && cut->seconds() > last_words) {
    inter = MPI_COMM_NULL;
    end(exit_killed, fmt::format("{} died without a word: its connection is gone", peer));
  }
}

/// A message of any kind: one look, where one for each tag would cost the other program's cores as many times as much.
/// Open MPI looks first and fetches then: what came meanwhile is seen the second time.
bool Channel::State::is_anything_there() const {
  if (stand_in) return true;
  int there = 0;
  for (int look = 0; look < 2 && !there; ++look)
    check_mpi(MPI_Iprobe(MPI_ANY_SOURCE, MPI_ANY_TAG, inter, &there, MPI_STATUS_IGNORE), "MPI_Iprobe");
  return there != 0;
}

/// A message with that tag has come.
bool Channel::State::is_there(int tag) const {
  if (stand_in) return stand_in->next(tag);
  int there = 0;
  check_mpi(MPI_Iprobe(0, tag, inter, &there, MPI_STATUS_IGNORE), "MPI_Iprobe");
  return there != 0;
}

void Channel::State::at_exit() {
  if (active && active->open && !ending)
    active->end(exit_left, "the program called exit() while the coupling was open");
}

void Channel::State::at_terminate() {
  std::string text = "terminate() was called";
  if (const auto exception = std::current_exception()) {
    text = "uncaught exception";
    try {
      std::rethrow_exception(exception);
    } catch (const std::exception& e) {
      text = fmt::format("uncaught exception: {}", e.what());
    } catch (...) {
    }
  }
  if (active) active->end(exit_terminate, text);
  _exit(exit_terminate);
}

// --- life
// -----------------------------------------------------------------------------------------------------------------------

Channel::Channel(const Comm& mine, MPI_Comm inter, Role role, const ChannelLimits& limits,
                 std::unique_ptr<Lifeline> line)
    : state_(std::make_shared<State>()) {
  state_->mine = mine;
  state_->inter = inter;
  state_->role = role;
  state_->limits = limits;
  state_->line = std::move(line);
  const char* other = name_of(role == Role::solid ? Role::fluid : Role::solid);
  state_->bell = std::make_unique<Bell>(name_of(role), other, mine.rank());
  check_mpi(MPI_Comm_set_errhandler(inter, MPI_ERRORS_RETURN), "MPI_Comm_set_errhandler");
  prctl(PR_SET_TIMERSLACK, 1000ul);  // ns: naps of 50 us would else last up to 100
  state_->become_active();
  state_->watch_silence();
}

Channel::Channel(const Comm& mine, std::unique_ptr<StandIn> stand_in, Role role) : state_(std::make_shared<State>()) {
  state_->mine = mine;
  state_->role = role;
  state_->stand_in = std::move(stand_in);
  state_->become_active();
}

void Channel::State::become_active() {
  active = shared_from_this();
  std::set_terminate(at_terminate);
  static const int once = std::atexit(at_exit);
  (void)once;
  set_failure_hook([](int code, const std::string& text) {
    active->end(code, text.empty() ? "the program ended with an error code" : text, !text.empty());
  });
}

Channel::~Channel() {
  if (state_->open && std::uncaught_exceptions() == 0)
    state_->end(exit_left, "the program left its run while the coupling was open");
}

const Comm& Channel::mine() const { return state_->mine; }
Role Channel::role() const { return state_->role; }
const std::string& Channel::peer() const { return state_->peer; }
double Channel::seconds_waited() const { return state_->waited; }

void Channel::set_peer(const std::string& name, double silence_limit) {
  state_->peer = name;
  state_->limits.silence = silence_limit;
}

void Channel::set_place(int64_t window, double t) {
  state_->window = window;
  state_->t = t;
  if (leader()) set_notice(state_->place());
  state_->watch_silence();
}

void Channel::close() {
  state_->open = false;
  state_->stand_in.reset();
  quiet_notice();
  stop_watching();
}

// --- messages
// -------------------------------------------------------------------------------------------------------------------

void Channel::send(int tag, const void* data, size_t bytes) {
  if (bytes > size_t(INT32_MAX))
    fail(exit_malformed, fmt::format("a {} message of {} bytes is too long", word_of(tag), bytes));
  if (state_->stand_in) {
    if (const Verdict fault = state_->stand_in->take(tag, {static_cast<const char*>(data), bytes}))
      fail(fault->code, fault->text);
    return;
  }
  state_->large_pages.use(tag, data, bytes);
  MPI_Request request;
  check_mpi(MPI_Isend(data, int(bytes), MPI_BYTE, 0, tag, state_->inter, &request), "MPI_Isend");
  state_->started.push_back(request);
  state_->rung = false;
}

void Channel::ring() {
  if (state_->bell && !state_->rung) state_->bell->ring();
  state_->rung = true;
}

void Channel::flush() {
  const Patience patience;
  ring();
  if (state_->line) {  // Open MPI 4.1 may not come back from MPI_Testall when the other end of a connection is gone
    watched = state_->line.get();
    watch_for(is_watched_cut, 1, exit_killed,
              fmt::format("FAILED{}: {} died without a word: its connection is gone", state_->place(), peer()));
  }
  for (;;) {
    int all = 0;
    check_mpi(MPI_Testall(int(state_->started.size()), state_->started.data(), &all, MPI_STATUSES_IGNORE),
              "MPI_Testall");
    if (all) break;
    state_->look_for_failure();
    if (patience.seconds() > state_->limits.silence)
      fail(exit_silence, fmt::format("{} has not taken a message for {:g} s", peer(), state_->limits.silence));
    patience.rest();  // the other one rings when it answers, not when it has taken all
  }
  state_->started.clear();
  watched = nullptr;
  if (state_->line) state_->watch_silence();
}

int Channel::wait(std::initializer_list<int> tags) {
  const Patience patience;
  double next_line = state_->limits.heartbeat;
  bool may_bye = false;
  for (const int tag : tags) may_bye |= tag == tag_bye;
  for (;;) {
    const bool any = state_->is_anything_there();
    for (const int tag : tags)
      if (any && state_->is_there(tag)) {
        state_->waited += patience.seconds();
        return tag;
      }
    state_->look_for_failure(any);
    const char* word = word_of(*tags.begin());
    if (any && !may_bye && state_->is_there(tag_bye)) {
      ByeBlock bye{};
      receive(tag_bye, "BYE", &bye, sizeof bye);
      bye.text[sizeof bye.text - 1] = 0;
      fail(exit_bye, fmt::format("{} said BYE ({}) while {} was expected", peer(), bye.text, word));
    }
    if (state_->stand_in) fail(exit_malformed, fmt::format("{} has no {} to give", peer(), word));
    const double waited = patience.seconds();
    if (waited > state_->limits.silence)
      fail(exit_silence, fmt::format("no {} from {} for {:g} s (silence limit)", word, peer(), state_->limits.silence));
    if (waited > next_line) {
      say("waiting for {} from {} since {:.0f} s{}", word, peer(), waited, state_->place());
      next_line += state_->limits.heartbeat;
    }
    patience.rest(*state_->bell);
  }
}

size_t Channel::size_of(int tag) const {
  if (state_->stand_in) return state_->stand_in->next(tag)->bytes.size();
  MPI_Status status;
  int bytes = 0;
  check_mpi(MPI_Probe(0, tag, state_->inter, &status), "MPI_Probe");
  check_mpi(MPI_Get_count(&status, MPI_BYTE, &bytes), "MPI_Get_count");
  return size_t(bytes);
}

void Channel::receive(int tag, const char* message, void* data, size_t bytes) {
  wait({tag});  // the parts of one exchange are under way together: this one is there, or will be at once
  const size_t arrived = size_of(tag);
  if (arrived != bytes)
    fail(exit_malformed, fmt::format("{} from {} has {} bytes, {} were expected", message, peer(), arrived, bytes));
  if (const auto& stand_in = state_->stand_in) {
    const StandIn::Message* message = stand_in->next(tag);
    std::copy(message->bytes.begin(), message->bytes.end(), static_cast<char*>(data));
    stand_in->drop(message);
    return;
  }
  state_->large_pages.use(tag, data, bytes);
  check_mpi(MPI_Recv(data, int(bytes), MPI_BYTE, 0, tag, state_->inter, MPI_STATUS_IGNORE), "MPI_Recv");
}

void Channel::poll() {
  state_->watch_silence();
  state_->look_for_failure();
}

void Channel::share(void* data, size_t bytes) { share_politely(mine(), data, bytes, state_->bell.get()); }

void Channel::fail(int code, const std::string& text) { state_->end(code, text); }

}  // namespace bw::coupling
