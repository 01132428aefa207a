// One line of JSON a PDU, for `belvedere-dis decode`; docs/dis.md names the fields.
#pragma once

#include "dis/codec.h"

#include <cstdint>
#include <string>

namespace belvedere::dis {

std::string PduJson(uint64_t frame, const Pdu& pdu);

}  // namespace belvedere::dis
