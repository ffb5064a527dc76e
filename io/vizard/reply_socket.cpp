#include "io/vizard/reply_socket.h"

#include <dlfcn.h>
#include <zmq.h>

#include <cerrno>
#include <utility>

#include "render/vocabulary/check.h"

namespace hilcam {
namespace {

// ABI 5 is that of all releases since 4.1 (2014).
constexpr const char* kLibrary = "libzmq.so.5";

// The functions that are used, by the library's names.
struct Library {
    decltype(&zmq_ctx_new) ctx_new;
    decltype(&zmq_ctx_term) ctx_term;
    decltype(&zmq_socket) socket;
    decltype(&zmq_close) close;
    decltype(&zmq_setsockopt) setsockopt;
    decltype(&zmq_bind) bind;
    decltype(&zmq_poll) poll;
    decltype(&zmq_send) send;
    decltype(&zmq_msg_init) msg_init;
    decltype(&zmq_msg_recv) msg_recv;
    decltype(&zmq_msg_data) msg_data;
    decltype(&zmq_msg_size) msg_size;
    decltype(&zmq_msg_more) msg_more;
    decltype(&zmq_msg_close) msg_close;
    decltype(&zmq_errno) last_errno;
    decltype(&zmq_strerror) strerror;
};

Library load_library() {
    // Never closed: its threads may outlive a socket.
    void* const file = dlopen(kLibrary, RTLD_NOW | RTLD_LOCAL);
    if (!file)
        throw InputError(std::string("commands.vizard needs ZeroMQ, and ") + kLibrary +
                         " is not installed; accepted: with it (apt install libzmq5)");
    Library out{};
    const auto find = [&](auto& function, const char* name) {
        function = reinterpret_cast<std::remove_reference_t<decltype(function)>>(dlsym(file, name));
        if (!function) throw InputError(std::string(kLibrary) + " has no function " + name);
    };
    find(out.ctx_new, "zmq_ctx_new");
    find(out.ctx_term, "zmq_ctx_term");
    find(out.socket, "zmq_socket");
    find(out.close, "zmq_close");
    find(out.setsockopt, "zmq_setsockopt");
    find(out.bind, "zmq_bind");
    find(out.poll, "zmq_poll");
    find(out.send, "zmq_send");
    find(out.msg_init, "zmq_msg_init");
    find(out.msg_recv, "zmq_msg_recv");
    find(out.msg_data, "zmq_msg_data");
    find(out.msg_size, "zmq_msg_size");
    find(out.msg_more, "zmq_msg_more");
    find(out.msg_close, "zmq_msg_close");
    find(out.last_errno, "zmq_errno");
    find(out.strerror, "zmq_strerror");
    return out;
}

const Library& library() {
    static const Library loaded = load_library();
    return loaded;
}

// Throws the library's message when a call has failed.
void require(bool done) {
    if (!done) throw DeviceError(library().strerror(library().last_errno()));
}

// Repeats a call that a signal interrupts, and returns its result.
template <class Call>
int persistently(const Call& call) {
    int result = 0;
    do result = call();
    while (result < 0 && library().last_errno() == EINTR);
    require(result >= 0);
    return result;
}

class Message {
  public:
    Message() { library().msg_init(&message_); }
    ~Message() { library().msg_close(&message_); }
    Message(const Message&) = delete;
    Message& operator=(const Message&) = delete;
    zmq_msg_t* get() { return &message_; }
    std::string text() {
        return {static_cast<const char*>(library().msg_data(&message_)), library().msg_size(&message_)};
    }
    bool has_more() { return library().msg_more(&message_) != 0; }

  private:
    zmq_msg_t message_;
};

}  // namespace

struct ReplySocket::Handles {
    void* context = nullptr;
    void* socket = nullptr;

    void set(int option, const void* value, std::size_t size) const {
        require(library().setsockopt(socket, option, value, size) == 0);
    }
    ~Handles() {
        if (socket) library().close(socket);
        if (context) library().ctx_term(context);
    }
};

ReplySocket::ReplySocket(std::int64_t max_bytes) : handles_(std::make_unique<Handles>()) {
    handles_->context = library().ctx_new();
    require(handles_->context != nullptr);
    handles_->socket = library().socket(handles_->context, ZMQ_REP);
    require(handles_->socket != nullptr);
    const int linger_ms = 0, max_waiting = 1;  // a simulator waits for its answer
    handles_->set(ZMQ_LINGER, &linger_ms, sizeof linger_ms);
    handles_->set(ZMQ_RCVHWM, &max_waiting, sizeof max_waiting);
    handles_->set(ZMQ_MAXMSGSIZE, &max_bytes, sizeof max_bytes);
}

ReplySocket::~ReplySocket() = default;

void ReplySocket::listen(const std::string& address) {
    require(library().bind(handles_->socket, address.c_str()) == 0);
}

void ReplySocket::admit_only(pid_t process) { handles_->set(ZMQ_IPC_FILTER_PID, &process, sizeof process); }

bool ReplySocket::wait(int wakeup_fd) {
    zmq_pollitem_t watched[] = {{handles_->socket, 0, ZMQ_POLLIN, 0}, {nullptr, wakeup_fd, ZMQ_POLLIN, 0}};
    const int ready = library().poll(watched, 2, -1);
    require(ready >= 0 || library().last_errno() == EINTR);
    return ready > 0 && (watched[0].revents & ZMQ_POLLIN) != 0;
}

std::vector<std::string> ReplySocket::receive(std::size_t most) {
    std::vector<std::string> parts;
    Message part;
    do {
        persistently([&] { return library().msg_recv(part.get(), handles_->socket, 0); });
        if (parts.size() < most) parts.push_back(part.text());
    } while (part.has_more());
    return parts;
}

void ReplySocket::send(const std::vector<std::string>& parts) {
    for (std::size_t i = 0; i < parts.size(); ++i) {
        const int more = i + 1 < parts.size() ? ZMQ_SNDMORE : 0;
        persistently(
            [&] { return library().send(handles_->socket, parts[i].data(), parts[i].size(), more); });
    }
}

void ReplySocket::close() noexcept { handles_.reset(); }

}  // namespace hilcam
