#pragma once
// Makes the transfer tables beside a run that has begun without them (loop.wait_for_light), and gives
// them to the cameras' renderers: one camera after the other, on one thread that runs when nothing else wants
// its core.

#include <atomic>
#include <exception>
#include <string>
#include <thread>
#include <vector>

#include "emulator/scenario/light_loader.h"
#include "render/frame/renderer.h"

namespace hilcam {

inline constexpr const char* kLightThreadName = "light";

class LightMaker {
  public:
    // The tables that a camera's scene is still without; the renderer outlives this.
    struct Job {
        Renderer* renderer;
        std::vector<TableOrder> orders;
    };

    explicit LightMaker(std::vector<Job> jobs);
    ~LightMaker() { stop(); }
    LightMaker(const LightMaker&) = delete;
    LightMaker& operator=(const LightMaker&) = delete;

    void start();
    // Gives up what is not made yet. Owner thread.
    void stop() noexcept;

    // Returns how much of all tables is made, 0 to 1. Any thread.
    double share() const;
    // All tables are made and given. Any thread.
    bool is_done() const { return done_.load(std::memory_order_acquire); }
    // The time that took; when it is done.
    double seconds() const { return seconds_; }

  private:
    struct GivenUp : std::exception {};

    std::vector<Job> jobs_;
    std::size_t tables_ = 0;
    std::atomic<std::size_t> made_{0};
    std::atomic<double> share_of_next_{0};
    std::atomic<bool> stopping_{false}, done_{false};
    double seconds_ = 0;
    std::thread thread_;

    void run();
    void make(Job& job);
    std::shared_ptr<const TransferTable> make(const TableOrder& order);
    void watch(double share);
};

}  // namespace hilcam
