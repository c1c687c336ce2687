#include "acquisition/http/request_reader.hpp"

#include <gtest/gtest.h>

namespace biotomy::tests {
namespace {

using namespace acquisition;
using Outcome = RequestReader::Outcome;

/// What the reader says of bytes that never come to an end of their own, and the status it refuses
/// them with.
int refusal_of(const std::string& text) {
  RequestReader reader;
  std::string bytes = text;
  return reader.take(bytes) == Outcome::refused ? reader.refusal().status : 0;
}

TEST(RequestReader, ReadsARequestByteByByte) {
  const std::string text =
      "POST /api/v1/control/pause?a=b HTTP/1.1\r\nHost: rig:8080\r\nAuthorization: Bearer x\r\n"
      "Origin: http://rig:8080\r\nSec-Fetch-Site: same-origin\r\nLast-Event-ID: 7\r\n"
      "If-Range: \"a\"\r\n"
      "Content-Length: 4\r\n\r\nbody";
  RequestReader reader;
  std::string bytes;
  for (std::size_t i = 0; i + 1 < text.size(); ++i) {
    bytes += text[i];
    ASSERT_EQ(reader.take(bytes), Outcome::needs_more) << i;
  }
  bytes += text.back();
  ASSERT_EQ(reader.take(bytes), Outcome::complete);
  EXPECT_TRUE(bytes.empty());
  const ReceivedRequest received = reader.request();
  EXPECT_EQ(received.request.method, "POST");
  EXPECT_EQ(received.request.path, "/api/v1/control/pause");
  EXPECT_EQ(received.request.query.at("a"), "b");
  EXPECT_EQ(received.request.host, "rig:8080");
  EXPECT_EQ(received.request.authorization, "Bearer x");
  EXPECT_EQ(received.request.origin, "http://rig:8080");
  EXPECT_EQ(received.request.sec_fetch_site, "same-origin");
  EXPECT_EQ(received.request.last_event_id, "7");
  EXPECT_EQ(received.request.if_range, "\"a\"");
  EXPECT_EQ(received.request.body, "body");
  EXPECT_TRUE(received.keep_alive);
}

TEST(RequestReader, LeavesTheNextRequestInItsPlace) {
  RequestReader reader;
  std::string bytes = "HEAD /a HTTP/1.1\r\n\r\nGET /b HTTP/1.0\r\n\r\n";
  ASSERT_EQ(reader.take(bytes), Outcome::complete);
  const ReceivedRequest first = reader.request();
  EXPECT_TRUE(first.head_only);
  EXPECT_EQ(first.request.method, "GET");
  EXPECT_EQ(first.request.path, "/a");
  ASSERT_EQ(reader.take(bytes), Outcome::complete);
  const ReceivedRequest second = reader.request();
  EXPECT_FALSE(second.head_only);
  EXPECT_EQ(second.request.path, "/b");
  EXPECT_FALSE(second.keep_alive);
}

TEST(RequestReader, RefusesABodyThatDoesNotSayHowLongItIs) {
  EXPECT_EQ(refusal_of("POST / HTTP/1.1\r\nTransfer-Encoding: chunked\r\n\r\n2\r\nab\r\n0\r\n\r\n"),
            411);
  EXPECT_EQ(refusal_of("POST / HTTP/1.1\r\nTransfer-Encoding: chunked\r\n\r\n"), 411);
}

TEST(RequestReader, RefusesALongHeaderAsOneHoweverItComes) {
  RequestReader reader;
  std::string bytes = "GET / HTTP/1.1\r\nX: ";
  Outcome outcome = Outcome::needs_more;
  for (int pieces = 0; outcome == Outcome::needs_more && pieces < 20; ++pieces) {
    bytes += std::string(4096, 'a');
    outcome = reader.take(bytes);
  }
  ASSERT_EQ(outcome, Outcome::refused);
  EXPECT_EQ(reader.refusal().status, 431);
}

TEST(RequestReader, RefusesWhatIsTooLong) {
  EXPECT_EQ(refusal_of("GET /" + std::string(9000, 'a') + " HTTP/1.1\r\n\r\n"), 414);
  EXPECT_EQ(refusal_of("GET /" + std::string(20000, 'a')), 414);
  EXPECT_EQ(refusal_of("GET / HTTP/1.1\r\nX: " + std::string(20000, 'a') + "\r\n\r\n"), 431);
  EXPECT_EQ(refusal_of("GET / HTTP/1.1\r\nX: " + std::string(20000, 'a')), 431);
  EXPECT_EQ(refusal_of("POST / HTTP/1.1\r\nContent-Length: 65537\r\n\r\n"), 413);
  EXPECT_EQ(refusal_of("POST / HTTP/1.1\r\nContent-Length: 65536\r\n\r\n"), 0);
  EXPECT_EQ(refusal_of("GET /" + std::string(8000, 'a') + " HTTP/1.1\r\n"), 0);
}

TEST(RequestReader, RefusesWhatIsNoRequest) {
  for (const char* text : {"\x16\x03\x01\x02\x00 tls", "GET\r\n\r\n", "GET / HTTP/9.9\r\n\r\n",
                           "GET /../etc/passwd HTTP/1.1\r\n\r\n", "GET http://a/ HTTP/1.1\r\n\r\n",
                           "GET / HTTP/1.1\r\nContent-Length: -1\r\n\r\n",
                           "POST / HTTP/1.1\r\nContent-Length: 1\r\nContent-Length: 2\r\n\r\nab",
                           "GET / HTTP/1.1\r\nno colon\r\n\r\n"}) {
    EXPECT_EQ(refusal_of(text), 400) << text;
  }
}

TEST(RequestReader, TellsOnceThatABodyIsWaitedFor) {
  RequestReader reader;
  std::string bytes = "POST / HTTP/1.1\r\nExpect: 100-continue\r\nContent-Length: 2\r\n\r\n";
  ASSERT_EQ(reader.take(bytes), Outcome::needs_more);
  EXPECT_TRUE(reader.take_expectation());
  EXPECT_FALSE(reader.take_expectation());
  bytes += "ab";
  EXPECT_EQ(reader.take(bytes), Outcome::complete);
}

}  // namespace
}  // namespace biotomy::tests
