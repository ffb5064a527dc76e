#pragma once
// Makes transfer tables during a run that began without them (loop.wait_for_light), and gives them to the
// cameras' renderers: one camera after the other, on one thread that runs when nothing else needs its core.

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
    // The tables that a camera's scene still lacks. The renderer must outlive this object.
    struct Job {
        Renderer* renderer;
        std::vector<TableOrder> orders;
    };

    explicit LightMaker(std::vector<Job> jobs);
    ~LightMaker() { stop(); }
    LightMaker(const LightMaker&) = delete;
    LightMaker& operator=(const LightMaker&) = delete;

    void start();
    // Drops unfinished tables. Owner thread.
    void stop() noexcept;

    // Returns the share of all tables that is finished, 0 to 1. Any thread.
    double share() const;
    // True when all tables are made and given. Any thread.
    bool is_done() const { return done_.load(std::memory_order_acquire); }
    // Returns how long it took, once it is done.
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
