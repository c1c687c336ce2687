#include "acquisition/http/own_host_names.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace biotomy::tests {
namespace {

using namespace acquisition;
using testing::IsEmpty;
using testing::UnorderedElementsAre;

TEST(NamesOfAHost, AreItsOwnAndThatOnTheLocalLink) {
  EXPECT_THAT(names_of_host("Rig", "", {}), UnorderedElementsAre("rig", "rig.local"));
  EXPECT_THAT(names_of_host("", "127.0.0.1 localhost\n", {"lab"}), IsEmpty());
}

TEST(NamesOfAHost, AreThoseOfItsLinesInTheFileOfHosts) {
  const char* hosts =
      "127.0.0.1\tlocalhost\n"
      "127.0.1.1\tRig.Lab.example\trig  # as Debian's installer writes it\n"
      "192.168.7.20 rig microscope\n"
      "192.168.7.21 rig2.lab.example rig2 #rig\n";
  EXPECT_THAT(names_of_host("rig", hosts, {}),
              UnorderedElementsAre("rig", "rig.local", "rig.lab.example", "microscope"));
}

TEST(NamesOfAHost, AreInTheDomainsOfItsResolver) {
  EXPECT_THAT(names_of_host("rig", "", {"Lab.example", ".", "example"}),
              UnorderedElementsAre("rig", "rig.local", "rig.lab.example", "rig.example"));
}

TEST(NamesOfAHost, AreWithoutItsDomainTooWhenItIsCalledByIt) {
  EXPECT_THAT(names_of_host("rig.lab.example", "", {"lab.example"}),
              UnorderedElementsAre("rig", "rig.local", "rig.lab.example"));
}

}  // namespace
}  // namespace biotomy::tests
