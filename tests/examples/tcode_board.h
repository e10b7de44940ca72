// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// What examples/tcode/tcode.ino uses of an Arduino: commands from the standard input, and the
/// pulses of its servos, in microseconds, on the standard output. A "~" lets a second pass.
#include <cstdio>
#include <iostream>

inline unsigned long now_ms = 0;
inline unsigned long millis() {
  return now_ms;
}

struct Servo {
  int pin = 0, last_us = 0;
  void attach(int to) { pin = to; }
  void writeMicroseconds(int width_us) {
    if (width_us != last_us) std::printf("%d:%d\n", pin, width_us);
    last_us = width_us;
  }
};

struct {
  void begin(long) {}
  bool available() {
    if (std::cin.peek() != '~') return std::cin.peek() != EOF;
    std::cin.get();
    now_ms += 1000;
    return false;
  }
  int read() { return std::cin.get(); }
} inline Serial;

void setup();
void loop();
int main() {
  setup();
  while (std::cin.peek() != EOF) loop();
}
