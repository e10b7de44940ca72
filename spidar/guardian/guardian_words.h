/// What host and guardian say to each other: a LastWill, a byte of errno back, and at last this.
#pragma once

namespace spidar {

constexpr char kDismissed = 'q';

}  // namespace spidar
