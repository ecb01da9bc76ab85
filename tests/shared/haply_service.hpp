// Answers as Haply's service does (tests/stand_ins/haply_service.py), in a process of its own. Linux only.
#pragma once

#include <poll.h>
#include <sched.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <glm/geometric.hpp>
#include <string>
#include <utility>

#include "core/math/types.hpp"
#include "stand_ins/stand_ins.hpp"

namespace tactus::shared {

class HaplyService {
public:
    explicit HaplyService(const char* manner = "") {
        int in[2], out[2];
        if (pipe(in) != 0 || pipe(out) != 0) {
            return;
        }
        process_ = fork();
        if (process_ == 0) {
            prctl(PR_SET_PDEATHSIG, SIGKILL);
            // As a service does that serves a thousand times a second, where the system grants it.
            const sched_param priority{60};
            sched_setscheduler(0, SCHED_FIFO, &priority);
            dup2(in[0], 0);
            dup2(out[1], 1);
            close(in[1]);
            close(out[0]);
            execlp("python3", "python3", "tests/stand_ins/haply_service.py", manner, nullptr);
            _exit(127);
        }
        close(in[0]);
        close(out[1]);
        to_ = in[1];
        from_ = out[0];
        port_ = static_cast<std::uint16_t>(std::strtol(line().c_str(), nullptr, 10));
    }
    ~HaplyService() {
        close(to_);
        kill(process_, SIGKILL);
        waitpid(process_, nullptr, 0);
        close(from_);
    }
    HaplyService(const HaplyService&) = delete;
    HaplyService& operator=(const HaplyService&) = delete;

    std::uint16_t port() const { return port_; }
    void drop() { tell("drop\n"); }
    void go_mad() { tell("mad\n"); }
    void lie(stand_ins::Field field, stand_ins::Lie lie) {
        constexpr const char* fields[] = {"position", "velocity", "rotation", "buttons"};
        constexpr const char* lies[] = {"none", "no_number", "infinite", "leaps", "frozen", "silent"};
        told_at_ = 0;
        tell(std::string("lie ") + fields[static_cast<int>(field)] + " " + lies[static_cast<int>(lie)] +
             "\n");
    }
    // That its grip is not "connected" or not "awake", and repeats its buttons; empty: it is both.
    void lose_grip(const std::string& status) {
        tell("lie buttons " + (status.empty() ? "none" : status) + "\n");
    }
    // The newest force that it was told, in its axes.
    std::string force() {
        while (take_force()) {
        }
        return force_;
    }
    // Which of its states the first such force has answered.
    int answered() {
        force();
        return answered_;
    }
    // How often it has had no answer to a state.
    int waited() {
        force();
        return waited_;
    }
    // How often it has had a frame of the protocol's own in place of an answer.
    int acknowledged() {
        force();
        return acknowledged_;
    }
    // When it first sent what it was made to say by lie() (on the steady clock); 0: not yet.
    Nanoseconds told_at() {
        newest_force();
        return told_at_;
    }

    // The same, in our axes, and the longest step of a force that grows since the last call (unit: newtons).
    Vec3 newest_force() {
        while (take_force()) {
            Vec3 theirs;
            std::sscanf(force_.c_str(), "%lf %lf %lf", &theirs.x, &theirs.y, &theirs.z);
            const Vec3 ours(theirs.x, theirs.z, -theirs.y);
            const Vec3 before = std::exchange(newest_, ours);
            if (glm::length(ours) > glm::length(before)) {
                most_step_ = std::max(most_step_, glm::distance(ours, before));
            }
        }
        return newest_;
    }
    double take_most_step() {
        newest_force();
        return std::exchange(most_step_, 0.0);
    }

private:
    // False where nothing new has come.
    bool take_force() {
        for (pollfd file{from_, POLLIN, 0}; poll(&file, 1, 0) > 0 && (file.revents & POLLIN) != 0;) {
            std::string said = line();
            if (said == "waited") {
                ++waited_;
            } else if (said == "acknowledged") {
                ++acknowledged_;
            } else if (said.starts_with("lied ")) {
                told_at_ = std::strtoll(said.c_str() + 5, nullptr, 10);
            } else {
                const std::size_t end = said.rfind(' ');
                answered_ = std::atoi(said.c_str() + end);
                force_ = said.substr(0, end);
                return true;
            }
        }
        return false;
    }
    void tell(const std::string& line) {
        static_cast<void>(write(to_, line.data(), line.size()) == static_cast<ssize_t>(line.size()));
    }
    std::string line() {
        std::string text;
        for (char c = 0; read(from_, &c, 1) == 1 && c != '\n';) {
            text += c;
        }
        return text;
    }

    pid_t process_ = 0;
    int to_ = -1, from_ = -1;
    std::uint16_t port_ = 0;
    std::string force_;
    Vec3 newest_{0.0};
    double most_step_ = 0.0;
    Nanoseconds told_at_ = 0;
    int waited_ = 0, acknowledged_ = 0, answered_ = 0;
};

}  // namespace tactus::shared
