// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Servos that follow T-code on the serial line, as examples/motors.py sends it: "L09999I10 R05000I10" and a line end.
/// They rest in the middle after the start, and when the line is silent: a program that was killed says no more.
#include <Servo.h>
#include <stdlib.h>
#include <string.h>

const char* const kAxes[] = {"L0", "R0"};
const int kPins[] = {9, 10};
const int kCount = sizeof kPins / sizeof *kPins;
const unsigned long kSilence_ms = 500;

Servo servos[kCount];
char line[128];
unsigned length = 0;
unsigned long heard_ms = 0;

/// From 0 to 1: of the turn that each servo makes, about 90 degrees.
void turn(int servo, double position) { servos[servo].writeMicroseconds(1000 + int(1000 * position + .5)); }

void rest() {
  for (int i = 0; i < kCount; ++i) turn(i, .5);
}

/// The digits behind an axis are those behind the point: "L05" is one half. What follows them, the time until the
/// next command, is left out: a servo has a speed of its own.
void obey(char* text) {
  for (char* word = strtok(text, " \r"); word; word = strtok(nullptr, " \r")) {
    double position = 0, unit = .1;
    char* digit = word + strnlen(word, 2);
    for (; *digit >= '0' && *digit <= '9'; ++digit, unit /= 10) position += unit * (*digit - '0');
    for (int i = 0; i < kCount; ++i) {
      if (!strncmp(word, kAxes[i], 2) && digit > word + 2) turn(i, position);
    }
  }
}

void setup() {
  Serial.begin(115200);
  for (int i = 0; i < kCount; ++i) servos[i].attach(kPins[i]);
  rest();
}

void loop() {
  while (Serial.available()) {
    const char c = Serial.read();
    if (c != '\n') {
      if (length < sizeof line) line[length++] = c;
      continue;
    }
    line[length < sizeof line ? length : 0] = 0;  // one that is too long is no command
    length = 0;
    obey(line);
    heard_ms = millis();
  }
  if (millis() - heard_ms > kSilence_ms) rest();
}
