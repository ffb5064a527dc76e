#pragma once
// The truth of a camera's frames on its way out: from the loop through slots allocated beforehand to a thread
// that turns it into text and pictures and sends it, to clients of a TCP port, as datagrams, and into files.
//
// The loop's first stage takes a slot for a frame and has the renderer fill it; its second stage, publishing
// the frame, hands it over. When all slots are taken the truth of a frame is dropped and counted, never the
// frame; where the folder's truth must be whole, the loop waits (when_slow.h). Its thread is nicer than those that make
// frames.
//
// A frame's line goes into the folder once it is known what has become of the frame's own file (frame_fates.h): the line
// of a frame whose file was lost says "file": false.

#include <netinet/in.h>

#include <atomic>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <semaphore>
#include <string>
#include <thread>
#include <vector>

#include "io/contract/frame_fates.h"
#include "io/contract/frame_sink.h"
#include "io/contract/truth_listener.h"
#include "io/system/fd.h"
#include "io/system/line_server.h"
#include "io/truth/truth_config.h"
#include "io/truth/truth_document.h"
#include "io/truth/truth_files.h"

namespace hilcam {

// The name by which `top -H` shows it.
inline constexpr const char* kTruthThreadName = "truth";

// The other outputs of the camera as far as they matter to its truth; all of it outlives the sink.
struct TruthSurroundings {
    TruthListener* listener =
        nullptr;                   // gets the lines of the frames that it wants, whatever outputs.truth says
    FrameFates* fates = nullptr;   // knows what becomes of frames' files; null: there are none
    bool has_live_output = false;  // another output hands frames to clients while they are made
};

class TruthSink : public FrameSink {
  public:
    // make_slot: gives a record with room for any frame; asked several times. Throws InputError. Owner thread.
    TruthSink(const TruthConfig& config, const TruthSource& source,
              const std::function<FrameTruth()>& make_slot, const TruthSurroundings& surroundings = {});
    ~TruthSink() override { stop(); }

    void start() override;
    // The record for this frame, its raster set, to be filled before the frame is published; null: its truth
    // is not asked for, or dropped. wanted: the listener wants this one. Loop, the thread that renders.
    FrameTruth* begin(const FrameRecord& record, bool wanted = false) noexcept;
    // Hands over what was begun for the frame. Loop, the thread that publishes.
    void publish(const DnImage& frame, const FrameRecord& record) noexcept override;
    bool has_room() const noexcept override;
    bool must_be_waited_for() const noexcept override { return waits_; }
    void stop() noexcept override;
    SinkReport report() const override;
    bool has_fault() const noexcept override;

  private:
    struct Slot {
        FrameTruth truth;
        FrameRecord record;
        std::atomic<std::uint64_t> frame{0};  // begun for; both of the loop's threads look at it
        bool for_outputs = false, for_listener = false;
    };
    // Both stages of the loop may hold one, and a third is written meanwhile.
    static constexpr std::size_t kSlots = 8, kFewerSlots = 4, kInLoop = 2;

    // The line of a frame that is written once its file is there, or lost.
    struct HeldLine {
        std::uint64_t frame;
        std::string text;
    };
    static constexpr std::size_t kMaxHeld = 256;  // a folder that stands still does not fill the memory

    bool has_outputs() const;
    bool loss_is_fault() const { return !config_.folder.empty() && config_.when_slow != WhenSlow::kDrop; }
    void run();
    void take_next();
    void deliver(const Slot& slot);
    void write_settled_lines(bool all);
    template <class Action>
    void count(const Action& action);
    void send_datagrams(const FrameTruth& truth, const FrameRecord& record, const std::string& line);

    TruthConfig config_;
    TruthDocument document_;
    TruthListener* listener_;
    FrameFates* fates_;
    bool waits_;
    std::vector<std::unique_ptr<Slot>> slots_;
    std::uint64_t offered_ = 0;
    // Slots taken, handed over, and free again; taken - done <= the number of slots.
    std::atomic<std::size_t> taken_{0}, ready_{0}, done_{0};
    std::counting_semaphore<> news_{0};
    std::binary_semaphore nice_{0};
    std::atomic<bool> open_{false};
    std::atomic<std::uint64_t> written_{0}, dropped_{0};  // dropped: what no file had room for, too
    std::atomic<std::uint64_t> not_sent_{0};              // datagrams that the system did not take
    std::atomic<std::uint64_t> told_{0};                  // frames whose truth the thread has dealt with
    std::atomic<double> took_ms_{0};                      // sum over these

    std::unique_ptr<LineServer> server_;
    std::vector<sockaddr_in> destinations_;
    Fd udp_;
    std::optional<TruthFiles> files_;
    std::deque<HeldLine> held_lines_;
    std::thread thread_;
    mutable std::mutex mutex_;
    std::string fault_;
};

}  // namespace hilcam
