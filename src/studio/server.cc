#include "studio/server.h"

#include <thread>
#include <utility>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <fmt/format.h>

#include "base/clock.h"
#include "studio/http_session.h"
#include "studio/server_shared.h"
#include "studio/tls.h"

namespace hvas::studio {

class Server::Impl {
 public:
  Impl(Workbench* workbench, std::vector<Example> examples, const ServerOptions& options)
      : shared_(std::make_shared<ServerShared>(workbench, std::move(examples), options)),
        acceptor_(context_),
        timer_(context_),
        pause_(context_) {
    shared_->lanes = &lanes_;
    workbench->on_event = [this](Json event) {
      asio::post(context_, [this, event = std::move(event)] { shared_->hub.Broadcast(event); });
    };
    workbench->on_frame = [this] {
      if (!has_frame_.exchange(true)) {
        asio::post(context_, [this] {
          has_frame_ = false;
          shared_->hub.PublishFrame();
        });
      }
    };
  }

  ~Impl() { Stop(); }

  Result<void> Start() {
    const ServerOptions& options = shared_->options;
    error_code error;
    const auto address = asio::ip::make_address(options.address, error);
    if (error) {
      return Fail(ErrorCode::kInvalid, "this is not an IP address", options.address,
                  "give an address of this machine, or 0.0.0.0 for all of them");
    }
    if (!address.is_loopback() && !options.tls) {
      return Fail(ErrorCode::kInvalid, "connections of other machines have to be encrypted",
                  options.address, "give a certificate, or listen on 127.0.0.1");
    }
    if (options.tls) {
      auto tls = MakeTls(*options.tls);
      if (!tls) {
        return Unexpected(tls.error());
      }
      shared_->tls = std::move(*tls);
    }
    SavedAccess kept = FindKeptAccess();
    const bool wants_kept_port = options.port == 0 && kept.port != 0;
    if (!wants_kept_port ||
        !Listen({address, kept.port})) {  // another program may use that port by now
      if (const auto listening = Listen({address, options.port}); !listening) {
        return listening;
      }
    }
    has_kept_links_ = kept.port == port();
    shared_->access =
        std::make_unique<Access>(options.names, port(), options.tls.has_value(), std::move(kept));
    shared_->SaveAccessState();
    shared_->UpdateParticipantLink();
    Accept();
    Tick();
    thread_ = std::thread([this] { Run(); });
    return {};
  }

  void Stop() {
    context_.stop();
    if (thread_.joinable()) {
      thread_.join();
    }
    lanes_.Stop();
    if (shared_->access != nullptr) {
      shared_->SaveAccessNow(shared_->access->Keep());
    }
    shared_->hub.DropClients();
    shared_->audit->Stop();
  }

  [[nodiscard]] bool has_kept_links() const { return has_kept_links_; }

  [[nodiscard]] std::uint16_t port() const {
    error_code ignored;
    return acceptor_.local_endpoint(ignored).port();
  }

  [[nodiscard]] std::string LinkFor(Role role, std::string_view host) const {
    return fmt::format("{}/#t={}", shared_->access->OriginOf(host), shared_->access->token(role));
  }

 private:
  /** What the start before has kept; nothing where there was none, or it cannot be used. */
  [[nodiscard]] SavedAccess FindKeptAccess() const {
    const auto& file = shared_->options.access_file;
    auto kept = file.empty() ? SavedAccess() : LoadAccess(file);
    if (!kept && kept.error().code != ErrorCode::kNotFound) {
      fmt::print(stderr, "warning: new links are made: {}\n", kept.error().ToString());
    }
    return kept ? std::move(*kept) : SavedAccess();
  }

  Result<void> Listen(const tcp::endpoint& wanted) {
    error_code error;
    acceptor_.close(error);
    acceptor_.open(wanted.protocol(), error);
    if (!error) {
      acceptor_.set_option(asio::socket_base::reuse_address(true), error);
      acceptor_.bind(wanted, error);
    }
    if (!error) {
      acceptor_.listen(asio::socket_base::max_listen_connections, error);
    }
    if (error) {
      const bool is_elsewhere = error == std::errc::address_not_available;
      return Fail(ErrorCode::kOutOfResource, error.message(),
                  fmt::format("{}:{}", wanted.address().to_string(), wanted.port()),
                  is_elsewhere ? "listen on an address of this machine, or on 0.0.0.0"
                               : "choose another port with --port, or leave it out");
    }
    return {};
  }

  /** What goes wrong with one client is the end of its connection, of nothing else. */
  void Run() {
    while (!context_.stopped()) {
      try {
        context_.run();
      } catch (const std::exception& failed) {
        fmt::print(stderr, "warning: a client's request failed: {}\n", failed.what());
      }
    }
  }

  void Accept() {
    acceptor_.async_accept([this](error_code error, tcp::socket socket) {
      if (error == asio::error::operation_aborted) {
        return;
      }
      if (error) {
        return AcceptLater();
      }
      StartHttpSession(std::move(socket), shared_);
      Accept();
    });
  }

  /** The system has no descriptor left, and would say so again at once. */
  void AcceptLater() {
    constexpr std::chrono::milliseconds kWaitForDescriptor(100);
    pause_.expires_after(kWaitForDescriptor);
    pause_.async_wait([this](error_code error) {
      if (!error) {
        Accept();
      }
    });
  }

  void Tick() {
    timer_.expires_after(std::chrono::seconds(1));
    timer_.async_wait([this](error_code error) {
      if (!error) {
        shared_->hub.PublishStatus();
        Tick();
      }
    });
  }

  asio::io_context context_{1};
  AnswerLanes lanes_;  ///< Its jobs hold sessions, which use the context.
  std::shared_ptr<ServerShared> shared_;
  tcp::acceptor acceptor_;
  asio::steady_timer timer_;
  asio::steady_timer pause_;
  std::atomic<bool> has_frame_{false};
  bool has_kept_links_{false};
  std::thread thread_;
};

Server::Server(Workbench* workbench, std::vector<Example> examples, ServerOptions options)
    : impl_(std::make_unique<Impl>(workbench, std::move(examples), std::move(options))) {}

Server::~Server() = default;

Result<void> Server::Start() {
  return impl_->Start();
}

void Server::Stop() {
  impl_->Stop();
}

std::uint16_t Server::port() const {
  return impl_->port();
}

bool Server::has_kept_links() const {
  return impl_->has_kept_links();
}

std::string Server::LinkFor(Role role, std::string_view host) const {
  return impl_->LinkFor(role, host);
}

}  // namespace hvas::studio
