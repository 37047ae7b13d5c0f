// SPDX-License-Identifier: Apache-2.0
#include "app/sound/sound_file.hpp"

namespace footlight::app {

struct SoundFile::Open {};

namespace {
Error without() { return input_error("built without libsndfile: sound files cannot be read or written"); }
}  // namespace

SoundFile::SoundFile(std::unique_ptr<Open> open) : open_(std::move(open)) {}
SoundFile::SoundFile(SoundFile&&) noexcept = default;
SoundFile& SoundFile::operator=(SoundFile&&) noexcept = default;
SoundFile::~SoundFile() = default;
Result<SoundFile> SoundFile::create(const std::string& /*file*/) { return without(); }
Result<Samples> SoundFile::read(const std::string& /*file*/) { return without(); }
Status<> SoundFile::write(std::span<const float> /*samples*/) { return without(); }

}  // namespace footlight::app
