// SPDX-License-Identifier: Apache-2.0
// The part of the case file that both programs read, and output times without drift.
#pragma once
#include <limits>
#include <string>

#include "common/io/keys.h"

namespace bw {

struct RunControl {
  std::string title;
  struct Time {
    double end = 0;     ///< [s]
    int max_steps = 0;  ///< 0: no limit
    template <class K>
    void describe(K& k) {
      k.required("end", end, dim::time, "the run ends at this time");
      k.optional("max_steps", max_steps, "the run ends after so many steps; 0: no limit");
      k.expect(end > 0, "end", "a positive time");
      k.expect(max_steps >= 0, "max_steps", "a number of steps, or 0 for no limit");
    }
  } time;
  struct Output {
    std::string directory = "out";
    double fields_every = 0, history_every = 0;  ///< [s]
    bool exact = false;                          ///< fields with all their bits
    template <class K>
    void describe(K& k) {
      k.optional("directory", directory, "where results go, relative to the current folder; created if absent");
      k.optional("fields_every", fields_every, dim::time,
                 "interval of field files (VTKHDF, with a .vtkhdf.series of true times); 0: none");
      k.optional("history_every", history_every, dim::time,
                 "interval of rows in the history tables (CSV); 0: every step");
      k.optional("exact", exact, "field files hold doubles (64 bits) instead of floats");
      k.expect(!directory.empty(), "directory", "a folder");
      k.expect(fields_every >= 0, "fields_every", "a positive time, or 0 for no field files");
      k.expect(history_every >= 0, "history_every", "a positive time, or 0 for a row every step");
    }
  } output;

  struct Checkpoint {
    double every = 0, every_wall = 0;  ///< [s] simulated, wall clock
    int every_steps = 0, keep = 2;
    template <class K>
    void describe(K& k) {
      k.optional("every", every, dim::time, "simulated time between checkpoints; 0: none by time");
      k.optional("every_steps", every_steps, "steps between checkpoints; 0: none by steps");
      k.optional("every_wall", every_wall, dim::time, "wall-clock time between checkpoints; 0: none. The signal USR1 asks for one at once");
      k.optional("keep", keep, "the latest checkpoints that stay; older ones are removed");
      k.expect(every >= 0, "every", "a positive time, or 0 for none");
      k.expect(every_steps >= 0, "every_steps", "a number of steps, or 0 for none");
      k.expect(every_wall >= 0, "every_wall", "a positive time, or 0 for none");
      k.expect(keep >= 1, "keep", "at least 1");
    }
  } checkpoint;

  /// At the top of the case file.
  template <class K>
  void describe(K& k) {
    k.optional("title", title, "free text, repeated in the results");
    k.table("time", time, "when the run ends");
    k.table("output", output, "what is written, where and how often");
    k.table("checkpoint", checkpoint, "files from which a run goes on bit for bit (--restart)");
  }
};

/// The times 0, interval, 2 interval ... as whole multiples, so that they never drift.
class Schedule {
 public:
  enum class Zero { never, every_step };  ///< what an interval of 0 means
  Schedule(double interval, Zero zero) : interval_(interval), every_step_(zero == Zero::every_step) {}

  /// True once for each multiple that t has reached (several passed in one step count once); true at t = 0.
  bool due(double t);
  /// The first multiple after t: where a step has to end. Infinity if the interval is 0.
  double next_time(double t) const;
  /// After a restart: multiples up to t are done.
  void skip_to(double t);

 private:
  double index_after(double t) const;
  double interval_;
  bool every_step_;
  double next_ = 0;  ///< index of the next multiple due; a double holds it exactly
};

}  // namespace bw
