// SPDX-License-Identifier: Apache-2.0
#include "config/lamp_currents.hpp"

namespace footlight::config {

LampCurrents read_currents(MappingReader& reader) {
  LampCurrents out;
  out.node_a = reader.quantity("node").value_or(0);
  out.red_a = reader.quantity("red").value_or(0);
  out.green_a = reader.quantity("green").value_or(0);
  out.blue_a = reader.quantity("blue").value_or(0);
  const bool has_colours = reader.has("red") || reader.has("green") || reader.has("blue");
  if (reader.has("lamp")) {
    const double colour_a = reader.quantity("lamp").value_or(0) / 3;
    if (has_colours) {
      reader.error("lamp", "the lamp's current is given twice, whole and by its colours",
                   "either lamp, or red, green and blue");
    }
    out.red_a = out.green_a = out.blue_a = colour_a;
  } else if (!has_colours) {
    reader.error(reader.position(), reader.path(), "nothing says what a lamp takes",
                 "red, green and blue, for example 20 mA each, or lamp");
  }
  return out;
}

}  // namespace footlight::config
