#pragma once
// Sends out the truth of a camera's frames. The loop fills preallocated slots; a thread turns them into text
// and pictures for clients of a TCP port, UDP destinations and files.
//
// The loop's first stage takes a slot for a frame and the renderer fills it; the second stage publishes the
// frame and hands the slot over. When all slots are taken, a frame's truth is dropped and counted, never the
// frame. If the folder needs all truth, the loop waits instead (when_slow.h). The thread has a higher nice
// value than those that make frames.
//
// A frame's line is written to the folder once the fate of the frame's own file is known (frame_fates.h): the
// line says "file": false when that file was lost.

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

// Name in `top -H`.
inline constexpr const char* kTruthThreadName = "truth";

// The camera's other outputs, as far as truth needs them. All of it outlives the sink.
struct TruthSurroundings {
    // Gets the lines of the frames that it wants, whatever outputs.truth says; may be null.
    TruthListener* listener = nullptr;
    FrameFates* fates = nullptr;   // has the fates of frames' files; null: there are none
    bool has_live_output = false;  // another output sends the same frames to clients during the run
};

class TruthSink : public FrameSink {
  public:
    // make_slot: returns a record with room for any frame; called several times. Throws InputError. Owner
    // thread.
    TruthSink(const TruthConfig& config, const TruthSource& source,
              const std::function<FrameTruth()>& make_slot, const TruthSurroundings& surroundings = {});
    ~TruthSink() override { stop(); }

    void start() override;
    // Returns the record for this frame, with its raster set, to be filled before the frame is published.
    // Null when its truth is not wanted or was dropped. wanted: the listener wants this one. Loop, rendering
    // thread.
    FrameTruth* begin(const FrameRecord& record, bool wanted = false) noexcept;
    // Hands over the record that was begun for the frame. Loop, publishing thread.
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
        // Frame that it was begun for; read by both of the loop's threads.
        std::atomic<std::uint64_t> frame{0};
        bool for_outputs = false, for_listener = false;
    };
    // The loop's two stages may hold one each while a third is written.
    static constexpr std::size_t kSlots = 8, kFewerSlots = 4, kInLoop = 2;

    // A line that waits until the frame's file is written or lost.
    struct HeldLine {
        std::uint64_t frame;
        std::string text;
    };
    static constexpr std::size_t kMaxHeld = 256;  // bounds memory while a folder is not written

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
    // Numbers of slots taken, handed over and freed; taken - done <= the number of slots.
    std::atomic<std::size_t> taken_{0}, ready_{0}, done_{0};
    std::counting_semaphore<> news_{0};
    std::binary_semaphore nice_{0};
    std::atomic<bool> open_{false};
    std::atomic<std::uint64_t> written_{0}, dropped_{0};  // dropped includes what no file had room for
    std::atomic<std::uint64_t> not_sent_{0};              // datagrams that the system did not take
    std::atomic<std::uint64_t> told_{0};                  // frames that the thread has finished
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
