/// Marks what the shared libraries export; everything else is hidden.
#pragma once

#define SPIDAR_API __attribute__((visibility("default")))
