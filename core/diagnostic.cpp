// SPDX-License-Identifier: Apache-2.0
#include "core/diagnostic.hpp"

#include <algorithm>

namespace footlight {
namespace {

const char* name_of(Severity severity) {
  switch (severity) {
    case Severity::error:
      return "error";
    case Severity::warning:
      return "warning";
    case Severity::note:
      return "note";
  }
  return "error";
}

}  // namespace

std::string to_text(const Diagnostic& diagnostic) {
  std::string out;
  const Position& at = diagnostic.position;
  if (!at.file.empty()) {
    out += at.file + ":";
    if (at.line > 0) out += std::to_string(at.line) + ":" + std::to_string(at.column) + ":";
    out += " ";
  }
  out += name_of(diagnostic.severity);
  out += ": ";
  if (!diagnostic.key_path.empty()) out += diagnostic.key_path + ": ";
  out += diagnostic.text;
  if (!diagnostic.hint.empty()) out += " (" + diagnostic.hint + ")";
  return out;
}

void Diagnostics::error(Position position, std::string key_path, std::string text, std::string hint) {
  add({Severity::error, std::move(position), std::move(key_path), std::move(text), std::move(hint)});
}

void Diagnostics::warning(Position position, std::string key_path, std::string text, std::string hint) {
  add({Severity::warning, std::move(position), std::move(key_path), std::move(text), std::move(hint)});
}

bool Diagnostics::has_errors() const {
  return std::any_of(list_.begin(), list_.end(), [](const Diagnostic& d) { return d.severity == Severity::error; });
}

std::vector<Diagnostic> Diagnostics::sorted() const {
  std::vector<Diagnostic> out = list_;
  std::stable_sort(out.begin(), out.end(),
                   [](const Diagnostic& a, const Diagnostic& b) { return a.position < b.position; });
  return out;
}

std::string Diagnostics::to_text() const {
  std::string out;
  for (const Diagnostic& d : sorted()) out += footlight::to_text(d) + "\n";
  return out;
}

}  // namespace footlight
