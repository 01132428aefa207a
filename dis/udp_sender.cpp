#include "dis/udp_sender.h"

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/multicast.hpp>
#include <boost/asio/ip/udp.hpp>

#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>

namespace belvedere::dis {
namespace {

using boost::asio::ip::udp;
using ErrorCode = boost::system::error_code;

constexpr size_t kBatch = 64;

class AsioSender final : public UdpSender {
 public:
  AsioSender() : socket_(io_) {}

  Status Open(const Endpoint& to, const std::string& interface_address) {
    where_ = to.ToString();
    ErrorCode error;
    const auto address = boost::asio::ip::make_address(to.address, error);
    if (error) return Status::Error("send to {}: {}; give a numeric address", where_, error.message());
    const udp::endpoint endpoint(address, to.port);
    socket_.open(endpoint.protocol(), error);
    if (error) return Status::Error("send to {}: cannot open a UDP socket: {}", where_, error.message());
    socket_.set_option(udp::socket::broadcast(true), error);
    socket_.set_option(udp::socket::send_buffer_size(1 << 20), error);
    if (address.is_multicast()) {
      socket_.set_option(boost::asio::ip::multicast::enable_loopback(true), error);
      socket_.set_option(boost::asio::ip::multicast::hops(4), error);
    }
    if (!interface_address.empty()) {
      const auto interface = boost::asio::ip::make_address_v4(interface_address, error);
      if (!error) socket_.set_option(boost::asio::ip::multicast::outbound_interface(interface), error);
      if (error) return Status::Error("interface {}: {}", interface_address, error.message());
    }
    socket_.connect(endpoint, error);
    if (error) return Status::Error("send to {}: {}; is the network there?", where_, error.message());
    return {};
  }

  Status Send(std::span<const uint8_t> datagram) override {
    while (true) {
      if (send(socket_.native_handle(), datagram.data(), datagram.size(), 0) >= 0) return {};
      if (!GoOn()) return Failed();
    }
  }

  Status SendMany(std::span<const uint8_t> bytes, size_t length) override {
    std::array<iovec, kBatch> pieces;
    std::array<mmsghdr, kBatch> messages;
    while (!bytes.empty()) {
      const size_t count = std::min(kBatch, bytes.size() / length);
      for (size_t i = 0; i < count; ++i) {
        // sendmsg does not write to what it is given; its type says otherwise.
        pieces[i] = {const_cast<uint8_t*>(bytes.data() + i * length), length};
        messages[i] = {};
        messages[i].msg_hdr.msg_iov = &pieces[i];
        messages[i].msg_hdr.msg_iovlen = 1;
      }
      const int sent = sendmmsg(socket_.native_handle(), messages.data(), static_cast<unsigned>(count), 0);
      if (sent < 0 && !GoOn()) return Failed();
      // An error left by an earlier datagram takes one call and sends none; the datagram is sent by the next.
      if (sent > 0) bytes = bytes.subspan(static_cast<size_t>(sent) * length);
    }
    return {};
  }

 private:
  // ECONNREFUSED tells of an earlier datagram that found no listener.
  static bool GoOn() { return errno == EINTR || errno == ECONNREFUSED; }
  Status Failed() const { return Status::Error("send to {}: {}", where_, std::strerror(errno)); }

  boost::asio::io_context io_{1};
  udp::socket socket_;
  std::string where_;
};

}  // namespace

Result<std::unique_ptr<UdpSender>> UdpSender::Open(const Endpoint& to, const std::string& interface_address) {
  auto sender = std::make_unique<AsioSender>();
  Status status = sender->Open(to, interface_address);
  if (!status.ok()) return status;
  return std::unique_ptr<UdpSender>(std::move(sender));
}

}  // namespace belvedere::dis
