#pragma once
/// What NHTSA says of a channel's data: DASTAT of an EV5 header, STATUS of a UDS file.

#include <string>
#include <string_view>

namespace crashsim::io {

/// What a status means for who uses the data.
struct NhtsaStatus {
  std::string problem;   ///< Why they must not be used: "no data were recorded (DASTAT NO)"; "" when nothing is wrong.
  bool is_known = true;  ///< False when the guide has no such status.
};

/// @param status a code ("CF") or its words ("CHANNEL FAILED"); empty says nothing.
/// @param field what the file calls it, for the message: "DASTAT".
NhtsaStatus nhtsa_status(std::string_view status, std::string_view field);

}  // namespace crashsim::io
