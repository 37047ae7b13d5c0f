// SPDX-License-Identifier: Apache-2.0
#include "app/stage_file.hpp"

#include <cstdint>

#include <elf.h>
#include <link.h>

#include "config/output_file.hpp"
#include "core/sha256.hpp"

namespace footlight::app {
namespace {

constexpr std::string_view kMagic = "footlight stages 1\n";
constexpr std::size_t kMostBytes = std::size_t{1} << 30U;

/// The build id in the notes of one loaded object; the program itself comes first.
int find_build_id(dl_phdr_info* object, std::size_t /*size*/, void* out) {
  for (int i = 0; i < object->dlpi_phnum; ++i) {
    const auto& header = object->dlpi_phdr[i];
    if (header.p_type != PT_NOTE) continue;
    const char* at = reinterpret_cast<const char*>(object->dlpi_addr + header.p_vaddr);
    const char* end = at + header.p_memsz;
    while (end - at >= static_cast<std::ptrdiff_t>(sizeof(ElfW(Nhdr)))) {
      const auto* note = reinterpret_cast<const ElfW(Nhdr)*>(at);
      const char* name = at + sizeof(*note);
      const char* value = name + ((note->n_namesz + 3U) & ~3U);
      if (note->n_type == NT_GNU_BUILD_ID && std::string_view(name, note->n_namesz) == std::string_view("GNU", 4)) {
        *static_cast<std::string*>(out) = std::string(value, note->n_descsz);
      }
      at = value + ((note->n_descsz + 3U) & ~3U);
    }
  }
  return 1;
}

std::string digest_of(std::string_view bytes) {
  Sha256 sum;
  return sum.text(bytes).hex();
}

}  // namespace

std::string build_id() {
  std::string id;
  dl_iterate_phdr(find_build_id, &id);
  return id;
}

Status<> save_stages(const planner::Stages& stages, const std::string& file) {
  planner::StageWriter body;
  body.text(build_id());
  const auto all = stages.all();
  body.add(all.size());
  for (const auto& [key, value] : all) body.add(key).text(value);
  const std::string bytes = body.take();
  return config::write_file(file, std::string(kMagic) + digest_of(bytes) + bytes);
}

Status<> load_stages(const std::string& file, planner::Stages& stages) {
  auto content = config::read_file(file, kMostBytes);
  if (!content) return std::move(content).error();
  std::string_view rest = *content;
  if (!rest.starts_with(kMagic)) return input_error("it holds no stages");
  rest.remove_prefix(kMagic.size());
  constexpr std::size_t kHex = 64;
  if (rest.size() < kHex || digest_of(rest.substr(kHex)) != rest.substr(0, kHex)) return input_error("it is harmed");
  planner::StageReader reader(rest.substr(kHex));
  const std::string id = build_id();
  if (id.empty() || reader.text() != id) return input_error("another build of the program made it");
  for (auto left = reader.get<std::size_t>(); left > 0 && !reader.failed(); --left) {
    const auto key = reader.get<planner::StageKey>();
    stages.load(key, reader.view());
  }
  if (!reader.whole()) return input_error("it is harmed");
  return Done{};
}

}  // namespace footlight::app
