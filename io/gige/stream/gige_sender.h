#pragma once
// Sends the frames of a ring as a GigE Vision stream, and resends packets on request. One thread, one socket.
//
// Packets leave in small batches with sleeps between them: a receiver's buffer (208 KiB by default) must hold
// a batch while the receiver waits for a core. For a receiver on this machine, the sender also waits for room
// in its buffer (receiver_room.h). Requests and test packets are served between the batches of a frame.
//
// A request of twenty bytes can ask for a whole frame, so requests get the capacity that frames leave. Fresh
// packets keep their schedule whatever is requested. Resent packets have a schedule of their own, at half of
// the stream's rate while a frame is being sent and at the full rate between frames. For each block, at most
// kMaxResent times its number of packets is resent, and for the whole stream what resend_budget.h permits;
// the rest is refused (PACKET_UNAVAILABLE). Example: for a block of 73 packets, 292 are resent.
//
// Late frames are spaced when the receiver's buffer cannot be observed (frame_spacing.h).

#include <atomic>
#include <functional>
#include <optional>
#include <thread>
#include <vector>

#include "io/contract/loss_count.h"
#include "io/gige/stream/frame_spacing.h"
#include "io/gige/stream/gige_blocks.h"
#include "io/gige/stream/gige_ring.h"
#include "io/gige/stream/pacer.h"
#include "io/gige/stream/packet_batch.h"
#include "io/gige/stream/receiver_room.h"
#include "io/gige/stream/resend_budget.h"
#include "io/system/bounded_queue.h"
#include "io/system/fd.h"
#include "render/vocabulary/latest.h"

namespace hilcam {

struct GigePaceConfig {
    double rate_bytes_s = 400e6;   // upper limit
    double spread_fraction = 0.5;  // share of the frame period that a frame may take; 0: as fast as the limit
    bool space_late_frames = true;  // false in lockstep, where frames cannot be late
};

// An order of the control side.
struct GigeOrder {
    enum class Kind : std::uint8_t { kResend, kTestPacket } kind = Kind::kResend;
    Endpoint to;
    std::uint64_t acquisition = 0, block = 0;
    std::uint32_t next = 0, last = 0;  // packet ids
    bool extended_ids = false;
    std::uint32_t packet_bytes = 0;  // the stream's; kTestPacket: IP and UDP headers included
    bool do_not_fragment = false;
};

class GigeSender {
  public:
    struct Counts {
        std::atomic<std::uint64_t> frames{0};           // delivered
        std::atomic<std::uint64_t> frames_spaced{0};    // late ones that waited for their turn
        LossCount frames_given_up;                      // late ones with newer ones behind them
        std::atomic<std::uint64_t> packets{0};          // sent for the first time
        std::atomic<std::uint64_t> packets_dropped{0};  // by faults
        LossCount packets_failed;                       // packets of frames that the kernel did not accept
        std::atomic<std::uint64_t> bytes{0};            // all packets, with IP and UDP headers
        std::atomic<std::uint64_t> resend_requests{0}, packets_resent{0}, packets_refused{0};
        std::atomic<std::uint64_t> packets_over_limit{0};   // refused because their block had had its share
        std::atomic<std::uint64_t> requests_unanswered{0};  // too many requests, or too many that are refused
        std::atomic<std::uint64_t> test_packets{0};
        // Test packets that the kernel did not accept: the client tries sizes until one is too large.
        std::atomic<std::uint64_t> test_packets_failed{0};
    };

    // A client that loses a share p of all packets asks for each p / (1 - p) times on average: once when half
    // are lost. Four times leaves room for the receivers of a multicast group, which ask one by one, and for
    // clients that request whole ranges when single packets are missing.
    static constexpr std::uint64_t kMaxResent = 4;

    // listener: may be null. finished: called on the sender's thread with the number of an acquisition when
    // its last frame has been sent.
    GigeSender(GigeRing& ring, FaultBoard& faults, DeliveryListener* listener, const GigePaceConfig& pace,
               std::function<void(std::uint64_t)> finished);
    ~GigeSender() { close(); }

    // Owner thread. open() may be called while the thread runs; the new socket is used from the next start()
    // on, after close(). It throws DeviceError. close() ends the thread and may be called twice.
    void open(std::uint32_t address);
    // Returns the port of the socket that was opened last.
    std::uint16_t port() const { return ntohs((next_socket_ ? next_address_ : address_).sin_port); }
    void start();
    void close() noexcept;

    // Control thread.
    void set_stream(const GigeStreamNow& now) { stream_.write(now), wake(wakeup_); }
    void set_frame_rate(double hz) { frame_rate_hz_.store(hz, std::memory_order_relaxed); }
    bool order(const GigeOrder& order) noexcept;  // false: too many already
    // Says that the ring has a frame. Loop.
    void frame_ready() noexcept { wake(wakeup_); }
    // Any thread.
    const Counts& counts() const { return counts_; }

  private:
    // A packet that a fault delays.
    struct Delayed {
        std::int64_t due_ns = 0;
        std::uint64_t acquisition = 0, block = 0;
        std::uint32_t id = 0;
        gvsp::Status status = gvsp::kFresh;
        std::int64_t id_error = 0;
        sockaddr_in to{};
    };
    static constexpr std::size_t kMaxDelayed = 4096;

    void run();
    // True when the client is still there and has not restarted since the frame was taken.
    bool wanted(const GigeSlot& slot);
    bool receiver_seen(const GigeSlot& slot) const;
    // Takes the next frame from the ring when there is none at hand, and sets when it may begin.
    void take_frame();
    void give_up_late_frames();
    void send_frame(GigeSlot& slot);
    void fill_batch(const GigeSlot& slot, PacketOrder& order);
    // Sends the batch, which belongs to that frame (0: to none), and charges it to `pacer`. wait: until the
    // receiver's buffer has room for it.
    void transmit(std::uint64_t frame, std::uint32_t packet_bytes, Pacer& pacer, bool wait = true);
    void set_do_not_fragment(bool on);
    Pace pace_of(const GigeSlot& slot);
    void delay(const GigeSlot& slot, std::uint32_t id, gvsp::Status status, const PacketFate& fate,
               const sockaddr_in& to);

    // Serves a small part of the orders; false: nothing is left to do at present.
    bool serve_orders();
    void serve_resend();
    void refuse(gvsp::Status reason, std::uint32_t last);
    void resend_batch(GigeSlot& slot, std::uint32_t end, std::uint64_t max_resent);
    void serve_delayed(std::int64_t now_ns);
    void send_test_packet(const GigeOrder& order);
    // Returns the frame when it is kept or is being sent.
    GigeSlot* borrow(std::uint64_t acquisition, std::uint64_t block, std::uint64_t& oldest);
    void give_back(GigeSlot* slot);
    // Serves orders until then; a fresh packet that is due comes first.
    void pause_until(std::int64_t due_ns);
    void sleep_until(std::int64_t due_ns);
    std::int64_t next_due_ns() const;

    GigeRing& ring_;
    FaultBoard& faults_;
    DeliveryListener* listener_;
    GigePaceConfig pace_config_;
    std::function<void(std::uint64_t)> finished_;
    Fd socket_, next_socket_, wakeup_;
    sockaddr_in address_{}, next_address_{};  // addresses of the sockets
    bool do_not_fragment_ = false;
    std::thread thread_;
    std::atomic<bool> stopping_{false};
    Latest<GigeStreamNow> stream_;
    std::atomic<double> frame_rate_hz_{0};
    BoundedQueue<GigeOrder, 1024> orders_;
    Counts counts_;

    // Owned by the thread.
    ReceiverRoom room_;
    Pacer pacer_, resend_pacer_, refusal_pacer_;
    PacketBatch batch_;
    GigeSlot* next_ = nullptr;  // the next to be sent
    std::int64_t next_begin_ns_ = 0;
    FrameSpacing spacing_;
    GigeSlot* current_ = nullptr;  // being sent
    ResendBudget budget_;
    std::optional<GigeOrder> resend_;
    BlockHistory history_;
    std::uint64_t history_of_ = 0;
    std::vector<Delayed> delayed_;  // holds no more than was reserved
};

}  // namespace hilcam
