#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "tests/faults/link_faults.hpp"

namespace biotomy::tests {

/// A bad line between a Modbus master and a slave: it passes on what both say, and spoils a part of
/// it as a plan says, by a seeded dice. It runs in a thread of its own until it is destroyed.
///
/// What one side writes at once counts as one message; a request and what follows it as one
/// exchange, of which at most one message is spoilt. Over TCP only the header of a message is
/// corrupted: TCP has a check of its own for the rest, and a byte that is changed in spite of it
/// can be told by nobody. On a serial line a delayed message holds up those after it, as it would
/// on a wire; over TCP they overtake it.
class FaultyLink {
 public:
  /// To the slave at `endpoint`, "tcp://…" or "rtu://…"; a master finds this end at endpoint(), of
  /// the same kind. The link to the pseudo-terminal of a serial line is made in `folder`.
  FaultyLink(const std::string& endpoint, const std::filesystem::path& folder,
             const LinkFaultPlan& plan);
  ~FaultyLink();
  FaultyLink(const FaultyLink&) = delete;
  FaultyLink& operator=(const FaultyLink&) = delete;

  std::string endpoint() const;
  LinkFaultCounts counts() const;

 private:
  class Line;
  std::unique_ptr<Line> line_;
};

}  // namespace biotomy::tests
