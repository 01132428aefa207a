#include "dis/udp_listener.h"

#include "runtime/base/log.h"

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/multicast.hpp>
#include <boost/asio/ip/udp.hpp>
#include <boost/asio/ip/v6_only.hpp>
#include <boost/asio/steady_timer.hpp>

#include <linux/sock_diag.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <algorithm>
#include <chrono>
#include <cstring>
#include <thread>
#include <vector>

namespace belvedere::dis {
namespace {

using boost::asio::ip::udp;
using ErrorCode = boost::system::error_code;

constexpr size_t kBatch = 64;
constexpr size_t kLongestDatagram = 65536;
constexpr int kBatchesPerWake = 64;  // then the timer gets its turn

UdpAddress ToAddress(const sockaddr_storage& storage) {
  UdpAddress address;
  if (storage.ss_family == AF_INET6) {
    sockaddr_in6 v6;
    std::memcpy(&v6, &storage, sizeof v6);
    std::memcpy(address.bytes.data(), &v6.sin6_addr, 16);
    address.port = ntohs(v6.sin6_port);
    address.v6 = true;
  } else {
    sockaddr_in v4;
    std::memcpy(&v4, &storage, sizeof v4);
    std::memcpy(address.bytes.data(), &v4.sin_addr, 4);
    address.port = ntohs(v4.sin_port);
  }
  return address;
}

// Room for one recvmmsg. Pages of it are touched only as far as datagrams are long.
class BatchBuffer {
 public:
  BatchBuffer() : bytes_(new uint8_t[kBatch * kLongestDatagram]), datagrams_(kBatch) {
    for (size_t i = 0; i < kBatch; ++i) {
      pieces_[i] = {bytes_.get() + i * kLongestDatagram, kLongestDatagram};
      messages_[i].msg_hdr.msg_iov = &pieces_[i];
      messages_[i].msg_hdr.msg_iovlen = 1;
      messages_[i].msg_hdr.msg_name = &senders_[i];
    }
  }
  // What was waiting, at most kBatch; empty when nothing was.
  std::span<const Datagram> Receive(int socket) {
    for (mmsghdr& message : messages_) message.msg_hdr.msg_namelen = sizeof(sockaddr_storage);
    const int count = recvmmsg(socket, messages_.data(), kBatch, MSG_DONTWAIT, nullptr);
    const size_t taken = count > 0 ? static_cast<size_t>(count) : 0;
    for (size_t i = 0; i < taken; ++i) {
      const uint8_t* start = bytes_.get() + i * kLongestDatagram;
      datagrams_[i] = {
          {start, messages_[i].msg_len}, ToAddress(senders_[i]), (messages_[i].msg_hdr.msg_flags & MSG_TRUNC) != 0};
    }
    return {datagrams_.data(), taken};
  }

 private:
  std::unique_ptr<uint8_t[]> bytes_;
  std::vector<Datagram> datagrams_;
  std::array<mmsghdr, kBatch> messages_{};
  std::array<iovec, kBatch> pieces_{};
  std::array<sockaddr_storage, kBatch> senders_{};
};

Status OpenSocket(const ListenOptions& options, udp::socket& socket) {
  const std::string where = options.listen.ToString();
  ErrorCode error;
  const auto address = boost::asio::ip::make_address(options.listen.address, error);
  if (error) return Status::Error("listen {}: {}; give a numeric address of this machine", where, error.message());
  const udp::endpoint endpoint(address, options.listen.port);
  socket.open(endpoint.protocol(), error);
  if (error) return Status::Error("listen {}: cannot open a UDP socket: {}", where, error.message());
  if (address.is_v6()) socket.set_option(boost::asio::ip::v6_only(!address.is_unspecified()), error);
  // Groups may have several listeners on a machine; a port of one's own must be one's own, or packets go astray.
  if (address.is_multicast()) socket.set_option(udp::socket::reuse_address(true), error);
  socket.bind(endpoint, error);
  if (error == boost::asio::error::address_in_use) {
    return Status::Error("listen {}: the port is in use; stop the other program or choose another port", where);
  }
  if (error) return Status::Error("listen {}: {}; give an address of this machine", where, error.message());
  if (!address.is_multicast()) return {};
  if (address.is_v6()) {
    socket.set_option(boost::asio::ip::multicast::join_group(address.to_v6(), address.to_v6().scope_id()), error);
  } else {
    const auto interface = options.interface_address.empty()
                               ? boost::asio::ip::address_v4::any()
                               : boost::asio::ip::make_address_v4(options.interface_address, error);
    if (error) return Status::Error("interface {}: {}", options.interface_address, error.message());
    socket.set_option(boost::asio::ip::multicast::join_group(address.to_v4(), interface), error);
  }
  if (error) {
    return Status::Error("listen {}: cannot join the multicast group: {}; name an interface that can", where,
                         error.message());
  }
  return {};
}

// What the kernel gives, after asking first as one who may have any size and then as anyone may.
int EnlargeReceiveBuffer(int socket, int wanted_bytes) {
  const socklen_t size = sizeof wanted_bytes;
  if (setsockopt(socket, SOL_SOCKET, SO_RCVBUFFORCE, &wanted_bytes, size) != 0) {
    setsockopt(socket, SOL_SOCKET, SO_RCVBUF, &wanted_bytes, size);
  }
  int given = 0;
  socklen_t given_size = sizeof given;
  getsockopt(socket, SOL_SOCKET, SO_RCVBUF, &given, &given_size);
  return given / 2;  // the kernel reports twice what may be asked for
}

class AsioListener final : public UdpListener {
 public:
  AsioListener(DatagramSink& sink, const Clock& clock) : sink_(sink), clock_(clock), socket_(io_), timer_(io_) {}
  ~AsioListener() override { Stop(); }

  Status Open(const ListenOptions& options) {
    Status status = OpenSocket(options, socket_);
    if (!status.ok()) return status;
    handle_ = socket_.native_handle();
    receive_buffer_bytes_ = EnlargeReceiveBuffer(handle_, options.receive_buffer_bytes);
    if (receive_buffer_bytes_ < options.receive_buffer_bytes / 2) {
      LogWarning(
          "listen {}: the kernel gives a receive buffer of {} KiB, {} KiB were asked for; raise net.core.rmem_max",
          options.listen.ToString(), receive_buffer_bytes_ >> 10, options.receive_buffer_bytes >> 10);
    }
    Wait();
    thread_ = std::thread([this] { io_.run(); });
    return {};
  }

  void Stop() override {
    io_.stop();
    if (thread_.joinable()) thread_.join();
  }

  uint64_t LostByKernel() const override {
    std::array<uint32_t, SK_MEMINFO_VARS> memory{};
    socklen_t size = sizeof memory;
    if (getsockopt(handle_, SOL_SOCKET, SO_MEMINFO, memory.data(), &size) != 0) return 0;
    return memory[SK_MEMINFO_DROPS];
  }
  int receive_buffer_bytes() const override { return receive_buffer_bytes_; }

 private:
  void Wait() {
    socket_.async_wait(udp::socket::wait_read, [this](const ErrorCode& error) {
      if (error) return;
      Drain();
      Wait();
    });
  }

  void Drain() {
    for (int i = 0; i < kBatchesPerWake; ++i) {
      const std::span<const Datagram> batch = buffer_.Receive(handle_);
      if (!batch.empty()) sink_.TakeBatch(batch, clock_.NowSeconds(), clock_.UtcSeconds());
      if (batch.size() < kBatch) break;
    }
    Settle();
  }

  void Settle() {
    const double now_s = clock_.NowSeconds();
    const std::optional<double> next_s = sink_.Settle(now_s);
    if (next_s == due_s_) return;
    due_s_ = next_s;
    timer_.cancel();
    if (!next_s) return;
    const double wait_s = std::clamp(*next_s - now_s, 0.0, 3600.0);
    timer_.expires_after(std::chrono::ceil<std::chrono::microseconds>(std::chrono::duration<double>(wait_s)));
    timer_.async_wait([this](const ErrorCode& error) {
      if (error) return;
      due_s_.reset();
      Settle();
    });
  }

  DatagramSink& sink_;
  const Clock& clock_;
  boost::asio::io_context io_{1};
  udp::socket socket_;
  boost::asio::steady_timer timer_;
  std::optional<double> due_s_;
  BatchBuffer buffer_;
  int handle_ = -1;
  int receive_buffer_bytes_ = 0;
  std::thread thread_;
};

}  // namespace

Result<std::unique_ptr<UdpListener>> UdpListener::Start(const ListenOptions& options, DatagramSink& sink,
                                                        const Clock& clock) {
  auto listener = std::make_unique<AsioListener>(sink, clock);
  Status status = listener->Open(options);
  if (!status.ok()) return status;
  return std::unique_ptr<UdpListener>(std::move(listener));
}

}  // namespace belvedere::dis
