#pragma once
/// The header of an NHTSA vehicle crash test, format EV5: sections of records with fields between bars.
/// Source: NHTSA Test Reference Guide, volume I, version 5.

#include <string>
#include <string_view>
#include <vector>

#include <crashsim/error.hpp>

#include "io/nhtsa_fields.hpp"

namespace crashsim::io {

struct NhtsaVehicle {
  int number = 0;
  double mass_kg = kUnset;    ///< VEHTWT.
  double speed_mps = kUnset;  ///< VEHSPD; unset when 0.
};

/// One record of the section INSTRUMENTATION.
struct NhtsaChannel {
  int vehicle = 0;                                                 ///< VEHNO; 0 is the barrier.
  int curve = 0;                                                   ///< CURNO, the channel's number.
  std::string sensor, occupant, attachment, axis, x_unit, y_unit;  ///< SENTYP SENLOC SENATT AXIS XUNITS YUNITS.
  double initial_speed_mps = kUnset;                               ///< INIVEL; unset when 0.
  long first = 0, last = 0;                                        ///< NFP, NLP: numbers of the first and last sample.
  double step_us = kUnset;                                         ///< DELT.
  std::string data_status, channel_status, comment;                ///< DASTAT CHSTAT INSCOM.
  std::string doubt;  ///< What is odd about it, with path and line; "" when nothing is.
};

struct NhtsaHeader {
  std::string title;
  double closing_speed_mps = kUnset, impact_angle_deg = 0.0, offset_mm = 0.0;  ///< CLSSPD IMPANG OFFSET.
  std::string barrier_rigidity;                                                ///< BARRIG: R rigid, D deformable.
  long declared_channels = -1;                                                 ///< TOTCRV; -1 when it is not filled in.
  std::vector<NhtsaVehicle> vehicles;
  std::vector<NhtsaChannel> channels;
  Metadata metadata;                  ///< Every filled field: {"VEHICLE[1].MODEL", "03"}.
  std::vector<std::string> warnings;  ///< What is odd in it, with path and line.
};

/// Whether a text starts as such a header does.
bool is_nhtsa_header(std::string_view text);

/// A header that lacks its end is read as far as its lines are whole.
/// @throws InvalidInput with path and line when a record lacks its essential fields or a number is none, and with path
///         when there are no channels.
NhtsaHeader parse_nhtsa_header(std::string_view text, const std::string& path);

}  // namespace crashsim::io
