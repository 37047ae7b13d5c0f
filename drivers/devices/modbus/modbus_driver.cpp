// SPDX-License-Identifier: Apache-2.0
#include "drivers/devices/modbus/modbus_driver.hpp"

#include <algorithm>
#include <utility>

#include "core/check.hpp"

namespace footlight::drivers {
namespace {

constexpr std::uint8_t kBroadcast = 0;
constexpr Duration kQuiet = milliseconds(20);        // a line that is silent for so long has nothing more to say
constexpr int kMostQuietRounds = 10;                 // nor does a node that never stops talking keep the others waiting
constexpr Duration kForget = milliseconds(1000);     // an open question after which there was silence
constexpr Duration kPollInterval = milliseconds(1);  // for a reply that is later than it should be
constexpr std::uint8_t kShowing = 1;                 // state of a node; what tells no state shows
constexpr std::uint8_t kAnyUnit = 1;                 // for budgets

/// Modbus Application Protocol V1.1b3, section 7.
enum Exception : std::uint8_t {
  kDeviceFailure = 4,  ///< the only one that is tried again at once
  kAcknowledge = 5,    ///< working on it
  kDeviceBusy = 6,
  kFenced = 7,  ///< of our own marker: a controller of a newer epoch leads it
  kGatewayPath = 10,
  kGatewayTarget = 11,
};

}  // namespace

ModbusDriver::ModbusDriver(ModbusPort& port, ModbusProfile profile, const std::vector<NodeAddress>& nodes,
                           std::uint8_t plan_byte, Leadership* leadership)
    : port_(port),
      profile_(std::move(profile)),
      nodes_(nodes),
      leadership_(leadership),
      plan_byte_(leadership == nullptr ? plan_byte : leading_byte(plan_byte, leadership->epoch)) {
  FL_CHECK(profile_.looks_per_register == 1 || profile_.looks_per_register == 2);
  for (const NodeAddress& node : nodes_) FL_CHECK(node.address >= 1 && node.address <= 247);
  looks_.fill(Look{{255, 255, 255}, Effect::steady, 255});
  looks_[kDark] = Look{{0, 0, 0}, Effect::steady, 0};
  looks_[kNoGuidance] = no_guidance_look();
}

Capabilities ModbusDriver::capabilities() const {
  Capabilities can;
  can.readback = profile_.status_register || profile_.readable_looks;
  can.proves_looks = profile_.proves_looks();
  can.lease = profile_.heartbeat_register.has_value();
  // Without a latch register the driver itself holds the looks back until the latch of their sequence.
  can.sequenced_latch = profile_.has_preload_sequence || !profile_.latch_register;
  if (profile_.states) can.looks = profile_.states->count;
  can.keeps_checks = modbus::kept_register(profile_).has_value();
  return can;
}

std::string ModbusDriver::assumption() const {
  if (profile_.proves_looks()) return {};
  std::string text = capabilities().readback
                         ? "looks are read back without a sequence: an answer later than its time-out is taken for lost"
                         : "nothing can be read back: what the device has acknowledged is taken for shown";
  if (!profile_.latch_register) text += "; without a latch its lamps change one node after the other";
  if (!profile_.heartbeat_register) text += "; it keeps its looks when the controller is silent";
  return text;
}

Look ModbusDriver::unguided() const {
  return profile_.heartbeat_register ? no_guidance_look() : Look{{}, Effect::steady, 0};
}

std::vector<LookIndex> ModbusDriver::values_of(std::span<const LookIndex> looks) const {
  std::vector<LookIndex> values(looks.begin(), looks.end());
  for (LookIndex& value : values) value = modbus::value_of(profile_, value, looks_[value]);
  return values;
}

Duration ModbusDriver::time_of(const modbus::Requests& requests) const {
  Duration sum{};
  for (const ModbusRequest& request : requests) sum += port_.wire_time(request) + profile_.pause_after_write;
  return sum;
}

Duration ModbusDriver::preload_time(int channels) const {
  const std::vector<LookIndex> looks(static_cast<std::size_t>(channels));
  return time_of(modbus::preload(profile_, kAnyUnit, plan_byte_, 1, looks));
}

Duration ModbusDriver::status_time() const {
  if (profile_.status_register) return port_.wire_time(modbus::status_request(profile_, kAnyUnit));
  if (profile_.readable_looks) return port_.wire_time(modbus::looks_request(profile_, kAnyUnit, profile_.channels));
  return {};
}

Duration ModbusDriver::latch_time() const {
  if (profile_.latch_register) {
    if (profile_.has_broadcast) return time_of(modbus::latch(profile_, kBroadcast, plan_byte_, 1));
    return static_cast<Duration::rep>(nodes_.size()) * time_of(modbus::latch(profile_, kAnyUnit, plan_byte_, 1));
  }
  Duration sum{};
  for (const NodeAddress& node : nodes_) sum += preload_time(node.channels);
  return sum;
}

Duration ModbusDriver::heartbeat_time() const {
  if (!profile_.heartbeat_register) return {};
  if (leadership_ != nullptr) {
    return time_of(modbus::heartbeat(profile_, kBroadcast, 0)) +
           time_of(modbus::lead(profile_, kBroadcast, plan_byte_, 0));
  }
  if (profile_.has_broadcast) return time_of(modbus::heartbeat(profile_, kBroadcast, 0));
  return static_cast<Duration::rep>(nodes_.size()) * time_of(modbus::heartbeat(profile_, kAnyUnit, 0));
}

Duration ModbusDriver::upload_time() const {
  if (profile_.has_broadcast) return time_of(modbus::look_entry(profile_, kBroadcast, 1, Look{}));
  return static_cast<Duration::rep>(nodes_.size()) * time_of(modbus::look_entry(profile_, kAnyUnit, 1, Look{}));
}

bool ModbusDriver::ready() const { return !under_way_ && jobs_.empty() && !paused_ && !port_.busy(); }

SendStatus ModbusDriver::start(Instant /*now*/) { return SendStatus::accepted; }

void ModbusDriver::append(std::vector<Job>& jobs, Purpose purpose, NodeIndex node, Sequence sequence,
                          modbus::Requests requests) {
  for (std::size_t i = 0; i < requests.size(); ++i) {
    jobs.push_back({purpose, node, sequence, std::move(requests[i]), false, i + 1 == requests.size()});
  }
}

std::vector<ModbusDriver::Job> ModbusDriver::to_all(
    Purpose purpose, Sequence sequence, const std::function<modbus::Requests(std::uint8_t unit)>& make) const {
  std::vector<Job> jobs;
  if (profile_.has_broadcast) {
    append(jobs, purpose, NodeIndex{}, sequence, make(kBroadcast));
    return jobs;
  }
  for (const NodeAddress& node : nodes_) append(jobs, purpose, node.node, sequence, make(node.unit()));
  return jobs;
}

SendStatus ModbusDriver::preload(const NodeAddress& node, Sequence sequence, std::span<const LookIndex> looks,
                                 Instant now) {
  FL_CHECK(sequence >= 1 && sequence <= kLastSequence);
  FL_CHECK(looks.size() == node.channels);
  if (!profile_.latch_register) {
    if (!ready()) return SendStatus::busy;
    kept_[node.node] = Kept{node, sequence, {looks.begin(), looks.end()}};
    due_.push_back({DeviceEvent::Kind::preloaded, node.node, sequence});
    return SendStatus::accepted;
  }
  std::vector<Job> writes;
  append(writes, Purpose::preload, node.node, sequence,
         modbus::preload(profile_, node.unit(), plan_byte_, sequence, values_of(looks)));
  const SendStatus status = run(std::move(writes), now);
  if (status == SendStatus::accepted) pending_[node.node] = Written{sequence, {looks.begin(), looks.end()}};
  return status;
}

SendStatus ModbusDriver::latch(Sequence sequence, Instant now) {
  FL_CHECK(sequence >= 1 && sequence <= kLastSequence);
  if (!ready()) return SendStatus::busy;
  std::vector<Job> writes;
  if (profile_.latch_register) {
    writes = to_all(Purpose::latch, sequence,
                    [&](std::uint8_t unit) { return modbus::latch(profile_, unit, plan_byte_, sequence); });
  } else {
    for (const auto& [node, kept] : kept_) {
      if (kept.sequence != sequence) continue;
      append(writes, Purpose::late_write, node, sequence,
             modbus::preload(profile_, kept.node.unit(), plan_byte_, sequence, values_of(kept.looks)));
    }
  }
  const SendStatus status = run(std::move(writes), now);
  if (status != SendStatus::accepted) return status;
  for (const auto& [node, pending] : pending_) {
    if (pending.sequence == sequence || !profile_.has_preload_sequence) written_[node] = {sequence, pending.looks};
  }
  for (const auto& [node, kept] : kept_) {
    if (kept.sequence == sequence) written_[node] = {sequence, kept.looks};
  }
  std::erase_if(kept_, [&](const auto& entry) { return entry.second.sequence == sequence; });
  return status;
}

SendStatus ModbusDriver::heartbeat(Duration show_time, Instant now) {
  if (!profile_.heartbeat_register) return SendStatus::accepted;
  const auto show_ms = static_cast<std::uint32_t>(show_time / milliseconds(1));
  auto beats =
      to_all(Purpose::heartbeat, 0, [&](std::uint8_t unit) { return modbus::heartbeat(profile_, unit, show_ms); });
  lead_due_ = lead_due_ || (leadership_ != nullptr && beats_since_lead_++ % kBeatsALead == 0);
  return run(std::move(beats), now);
}

SendStatus ModbusDriver::ask(const NodeAddress& node, Instant now) {
  if (profile_.status_register) {
    if (!ready() || quiet_) return SendStatus::busy;
    auto asked = question(node.node, node.unit(), now);
    if (asked) return run({{Purpose::status, node.node, 0, std::move(*asked)}}, now);
    due_.push_back({DeviceEvent::Kind::missed, node.node});
    return SendStatus::accepted;
  }
  if (!profile_.readable_looks) return SendStatus::accepted;
  return run({{Purpose::looks, node.node, 0, modbus::looks_request(profile_, node.unit(), node.channels)}}, now);
}

SendStatus ModbusDriver::upload_look(LookIndex index, const Look& look, Instant now) {
  const SendStatus status =
      run(to_all(Purpose::look, 0, [&](std::uint8_t unit) { return modbus::look_entry(profile_, unit, index, look); }),
          now);
  if (status == SendStatus::accepted && index != kDark && index != kNoGuidance) looks_[index] = look;
  return status;
}

std::optional<ModbusRequest> ModbusDriver::question(NodeIndex node, std::uint8_t unit, Instant now) {
  Known& known = known_[node];
  if (now - known.asked_at >= kForget) known.open = 0;
  for (std::uint16_t count = modbus::kStatusRegisters; count >= 1; --count) {
    if ((known.open >> count & 1U) != 0) continue;
    known.asked_at = now;
    return modbus::status_request(profile_, unit, count);
  }
  return std::nullopt;
}

SendStatus ModbusDriver::run(std::vector<Job> jobs, Instant now) {
  if (!ready()) return SendStatus::busy;
  if (jobs.empty()) return SendStatus::accepted;
  const Purpose purpose = jobs.front().purpose;
  const bool moment = jobs.front().request.unit == kBroadcast || purpose == Purpose::late_write ||
                      purpose == Purpose::latch || purpose == Purpose::heartbeat;
  if (quiet_ && !moment) return SendStatus::busy;
  if (lead_due_) {
    std::vector<Job> lead;
    append(lead, Purpose::heartbeat, {}, 0, modbus::lead(profile_, kBroadcast, plan_byte_, leadership_->epoch));
    jobs.insert(jobs.begin(), lead.begin(), lead.end());
  }
  const SendStatus status = submit(jobs.front(), now);
  if (status != SendStatus::accepted) return status;
  lead_due_ = false;
  jobs_.assign(jobs.begin() + 1, jobs.end());
  return status;
}

void ModbusDriver::take_plan(std::uint8_t plan_byte) {
  const std::uint8_t byte = leadership_ == nullptr ? plan_byte : leading_byte(plan_byte, leadership_->epoch);
  lead_due_ = lead_due_ || (leadership_ != nullptr && byte != plan_byte_);
  plan_byte_.store(byte);
}

SendStatus ModbusDriver::submit(const Job& job, Instant now) {
  if (job.request.unit != kBroadcast) port_.discard();
  const SendStatus status = port_.submit(job.request);
  if (status != SendStatus::busy) down_ = status == SendStatus::down;
  if (status != SendStatus::accepted) return status;
  under_way_ = job;
  expected_ = now + port_.wire_time(job.request);
  return status;
}

Instant ModbusDriver::step(Instant now, EventSink& events) {
  for (const DeviceEvent& event : due_) events.on_event(event);
  due_.clear();
  tell_bus(events);
  if (under_way_) {
    const std::optional<ModbusReply> reply = port_.poll();
    const bool broadcast_over = under_way_->request.unit == kBroadcast && !port_.busy();
    if (!reply && !broadcast_over) return expected_ > now ? expected_ : now + kPollInterval;
    const Job job = *std::exchange(under_way_, std::nullopt);
    if (reply && job.request.unit != kBroadcast) finish(job, *reply, now, events);
    const bool wrote = job.purpose != Purpose::status && job.purpose != Purpose::read_back &&
                       job.purpose != Purpose::looks && job.purpose != Purpose::kept;
    if (profile_.pause_after_write > Duration{} && wrote) {
      paused_ = true;
      pause_until_ = now + profile_.pause_after_write;
    }
  }
  paused_ = paused_ && now < pause_until_;
  if (quiet_ && now >= quiet_until_ && !port_.busy()) end_quiet(now);
  if (!paused_) submit_next(now, events);
  tell_bus(events);
  if (under_way_) return expected_ > now ? expected_ : now + kPollInterval;
  if (paused_) return pause_until_;
  if (!jobs_.empty()) return now + kPollInterval;
  return quiet_ ? quiet_until_ : kNever;
}

void ModbusDriver::submit_next(Instant now, EventSink& events) {
  if (jobs_.empty() || port_.busy()) return;
  const SendStatus status = submit(jobs_.front(), now);
  if (status == SendStatus::accepted) {
    jobs_.pop_front();
  } else if (status == SendStatus::down) {
    for (const Job& job : jobs_) {
      if (job.purpose != Purpose::service && job.purpose != Purpose::kept)
        events.on_event({DeviceEvent::Kind::missed, job.node, job.sequence});
    }
    service_.reset();
    jobs_.clear();
  }
}

void ModbusDriver::begin_quiet(Instant now) {
  quiet_ = true;
  quiet_rounds_ = 0;
  quiet_until_ = now + kQuiet;
}

void ModbusDriver::end_quiet(Instant now) {
  quiet_ = port_.discard() && ++quiet_rounds_ < kMostQuietRounds;
  if (quiet_) quiet_until_ = now + kQuiet;
}

void ModbusDriver::finish(const Job& job, const ModbusReply& reply, Instant now, EventSink& events) {
  const bool same = reply.unit == job.request.unit && reply.function == job.request.function;
  if (job.purpose == Purpose::service) {
    ModbusReply service = reply;
    if (!same && reply.outcome != ModbusReply::Outcome::timeout) service.outcome = ModbusReply::Outcome::garbled;
    if (service.outcome != ModbusReply::Outcome::ok && service.outcome != ModbusReply::Outcome::exception)
      begin_quiet(now);
    return finish_service(job, service, events);
  }
  if (job.purpose == Purpose::kept) return take_kept(job, reply, same, now, events);
  const bool question = job.purpose == Purpose::status || job.purpose == Purpose::read_back;
  if (reply.outcome == ModbusReply::Outcome::exception && same) {
    refuse(job, reply.exception_code, events);
  } else if (reply.outcome != ModbusReply::Outcome::ok || !same ||
             (question && reply.values.size() != job.request.count)) {
    known_[job.node].owes = true;
    if (question) known_[job.node].open |= static_cast<std::uint8_t>(1U << job.request.count);
    begin_quiet(now);
    drop_rest_of(job);
    events.on_event({DeviceEvent::Kind::missed, job.node, job.sequence});
  } else if (question) {
    take_status(job, reply, now, events);
  } else if (job.purpose == Purpose::looks) {
    tell_looks(job, reply, events);
  } else if (job.purpose == Purpose::preload && job.last) {
    receipt(job, now, events);
  }
}

void ModbusDriver::refuse(const Job& job, std::uint8_t code, EventSink& events) {
  DeviceEvent event{DeviceEvent::Kind::rejected, job.node, job.sequence};
  event.detail = code;
  // A refusal by one who owes an answer may be of something else.
  if (code == kGatewayPath || code == kGatewayTarget || known_[job.node].owes) {
    event.kind = DeviceEvent::Kind::missed;
  } else if (code == kFenced && leadership_ != nullptr && job.purpose == Purpose::preload) {
    leadership_->refusals.fetch_add(1, std::memory_order_relaxed);
    beats_since_lead_ = 0;
    event.kind = DeviceEvent::Kind::fenced;
  } else if (code == kDeviceFailure) {
    if (!job.retried) {
      jobs_.push_front(job);
      jobs_.front().retried = true;
      return;
    }
  } else {
    event.again = code == kAcknowledge || code == kDeviceBusy ? DeviceEvent::Again::later : DeviceEvent::Again::never;
  }
  drop_rest_of(job);
  events.on_event(event);
}

/// What is half written is begun anew, when the bus loop asks for it.
void ModbusDriver::drop_rest_of(const Job& job) {
  for (bool last = job.last; !last && !jobs_.empty(); jobs_.pop_front()) last = jobs_.front().last;
}

/// The device knows no sequence: its looks are compared with those written last.
void ModbusDriver::tell_looks(const Job& job, const ModbusReply& reply, EventSink& events) {
  const auto node = std::find_if(nodes_.begin(), nodes_.end(), [&](const auto& n) { return n.node == job.node; });
  FL_CHECK(node != nodes_.end());
  const auto values = modbus::decode_looks(profile_, node->channels, reply.values);
  if (!values) {
    events.on_event({DeviceEvent::Kind::missed, job.node, job.sequence});
    return;
  }
  const Written& written = written_[job.node];
  const bool as_written = !written.looks.empty() && values_of(written.looks) == *values;
  DeviceEvent event{DeviceEvent::Kind::showing, job.node, written.sequence};
  event.crc = static_cast<std::uint16_t>(looks_crc(written.looks) ^ (as_written ? 0U : 0xFFFFU));
  event.state = kShowing;
  events.on_event(event);
}

void ModbusDriver::receipt(const Job& job, Instant now, EventSink& events) {
  if (known_[job.node].owes && profile_.status_register && profile_.has_preload_sequence) {
    ask_on(job, Purpose::read_back, now, events);
  } else {
    events.on_event({DeviceEvent::Kind::preloaded, job.node, job.sequence});
  }
}

void ModbusDriver::ask_on(const Job& job, Purpose purpose, Instant now, EventSink& events) {
  if (auto asked = question(job.node, job.request.unit, now)) {
    jobs_.push_front({purpose, job.node, job.sequence, std::move(*asked)});
  } else {
    events.on_event({DeviceEvent::Kind::missed, job.node, job.sequence});
  }
}

void ModbusDriver::take_status(const Job& job, const ModbusReply& reply, Instant now, EventSink& events) {
  Known& known = known_[job.node];
  known.open = 0;
  known.owes = false;
  const auto status = modbus::decode_status(reply.values);
  if (!status) return ask_on(job, job.purpose, now, events);  // it has come to this question: now in full
  if (known.boots && *known.boots != status->boots) events.on_event({DeviceEvent::Kind::booted, job.node});
  known.boots = status->boots;
  if (job.purpose == Purpose::read_back) {
    const bool taken = status->pending_sequence == job.sequence || status->shown_sequence == job.sequence;
    events.on_event({taken ? DeviceEvent::Kind::preloaded : DeviceEvent::Kind::missed, job.node, job.sequence});
    return;
  }
  DeviceEvent event{DeviceEvent::Kind::showing, job.node, status->shown_sequence};
  event.crc = status->crc;
  event.state = status->state;
  event.boots = status->boots;
  events.on_event(event);
}

void ModbusDriver::tell_bus(EventSink& events) {
  if (down_ == down_told_) return;
  down_told_ = down_;
  events.on_event({down_ ? DeviceEvent::Kind::bus_down : DeviceEvent::Kind::bus_up, NodeIndex{}});
}

}  // namespace footlight::drivers
