// Our poses by OpenIGTLink against the library's own classes, both ways over loopback.
#include <gtest/gtest.h>

#include <chrono>
#include <thread>

#include "devices/igtl_stream.h"
#include "devices/igtl_tracker.h"
#include "igtlClientSocket.h"
#include "igtlMessageHeader.h"
#include "igtlServerSocket.h"
#include "igtlTrackingDataMessage.h"
#include "igtlTransformMessage.h"

namespace filum {
namespace igtl_library_test {

using namespace std::chrono_literals;

Pose known() {
  Pose X;
  X.p = Vec3(0.012, -0.034, 0.056);
  X.q = Quat(Eigen::AngleAxisd(1.1, Vec3(3, -1, 2).normalized()));
  return X;
}

void set_matrix(igtl::Matrix4x4& m, const Pose& X) {
  const Mat3 R = X.q.toRotationMatrix();
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j)
      m[i][j] = static_cast<float>(i < 3 && j < 3 ? R(i, j) : i < 3 ? 1e3 * X.p[i] : j == 3 ? 1.0 : 0.0);
}

void expect_known(const Pose& X) {
  EXPECT_LT((X.p - known().p).norm(), 1e-7);
  EXPECT_GT(std::abs(X.q.dot(known().q)), 1.0 - 1e-6);
}

TEST(IgtlLibrary, WhatTheLibrarySendsIsRead) {
  auto server = igtl::ServerSocket::New();
  ASSERT_EQ(server->CreateServer(0), 0);
  const int port = server->GetServerPort();
  ASSERT_GT(port, 0);
  std::jthread sender([&](const std::stop_token& stop) {
    auto socket = server->WaitForConnection(5000);
    if (socket.IsNull()) return;
    for (unsigned second = 1; !stop.stop_requested(); ++second) {
      auto transform = igtl::TransformMessage::New();
      transform->SetDeviceName("Tool0ToReference");
      igtl::Matrix4x4 m;
      set_matrix(m, known());
      transform->SetMatrix(m);
      transform->SetTimeStamp(second, 0);  // never left out: the library does not initialise it, and a constant one is a repetition
      transform->Pack();
      socket->Send(transform->GetPackPointer(), transform->GetPackSize());
      auto element = igtl::TrackingDataElement::New();
      element->SetName("Tool1");
      element->SetMatrix(m);
      auto data = igtl::TrackingDataMessage::New();
      data->SetDeviceName("Tracker");
      data->AddTrackingDataElement(element);
      data->SetTimeStamp(second, 0);
      data->Pack();
      socket->Send(data->GetPackPointer(), data->GetPackSize());
      std::this_thread::sleep_for(5ms);
    }
  });
  IgtlTracker tracker("127.0.0.1", port);
  std::vector<DeviceSample> samples;
  for (int k = 0; k < 5000 && samples.size() < 20; ++k) {
    tracker.poll(1000 * k, samples);
    std::this_thread::sleep_for(1ms);
  }
  ASSERT_GE(samples.size(), 20u);
  EXPECT_EQ(tracker.health().corrupt, 0u);
  EXPECT_EQ(tracker.repeated(), 0u);
  int first = 0;
  for (const DeviceSample& s : samples) {
    first += s.tool == 0 ? 1 : 0;
    ASSERT_LE(s.tool, 1);
    expect_known(s.X_WD);
  }
  EXPECT_NEAR(first, static_cast<double>(samples.size()) / 2, 1.0);
}

TEST(IgtlLibrary, WhatIsStreamedTheLibraryUnderstands) {
  IgtlStream stream("127.0.0.1", 0);
  auto socket = igtl::ClientSocket::New();
  ASSERT_EQ(socket->ConnectToServer("127.0.0.1", stream.port()), 0);
  for (int k = 0; k < 5; ++k) stream.send(1, known(), 1'500'000);
  auto header = igtl::MessageHeader::New();
  header->InitPack();
  ASSERT_EQ(socket->Receive(header->GetPackPointer(), header->GetPackSize()), header->GetPackSize());
  header->Unpack();
  EXPECT_STREQ(header->GetDeviceType(), "TRANSFORM");
  EXPECT_STREQ(header->GetDeviceName(), "Tool1");
  auto message = igtl::TransformMessage::New();
  message->SetMessageHeader(header);
  message->AllocatePack();
  socket->Receive(message->GetPackBodyPointer(), message->GetPackBodySize());
  ASSERT_TRUE(message->Unpack(1) & igtl::MessageHeader::UNPACK_BODY) << "the library's own check of the CRC";
  igtl::Matrix4x4 m;
  message->GetMatrix(m);
  Pose X;
  Mat3 R;
  for (int i = 0; i < 3; ++i) {
    X.p[i] = 1e-3 * m[i][3];
    for (int j = 0; j < 3; ++j) R(i, j) = m[i][j];
  }
  X.q = Quat(R);
  expect_known(X);
  unsigned int seconds = 0, nanoseconds = 0;
  header->GetTimeStamp(&seconds, &nanoseconds);
  EXPECT_EQ(seconds, 1u);
  socket->CloseSocket();
}

}  // namespace igtl_library_test
}  // namespace filum
