// The inputs of a session in a file of their own, and what is played of it.
#pragma once

#include <gtest/gtest.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "session/input_recorder.hpp"
#include "session/input_replay.hpp"

namespace tactus::session_test {

class RecordedInputs {
public:
    explicit RecordedInputs(const SessionSettings& settings = {},
                            std::size_t room = InputRecorder::usual_room)
        : recorder(room), path_(name()), file_(std::fopen(path_.c_str(), "wb")) {
        ByteSink sink;
        ValueWriter writer(sink);
        pass(writer, settings);
        EXPECT_TRUE(write_input_head(file_));
        put(InputPiece::settings, sink.bytes());
    }
    ~RecordedInputs() {
        std::fclose(file_);
        std::filesystem::remove(path_);
    }
    RecordedInputs(const RecordedInputs&) = delete;
    RecordedInputs& operator=(const RecordedInputs&) = delete;

    void put(InputPiece kind, const std::vector<std::byte>& content) {
        if (!content.empty()) {
            EXPECT_TRUE(write_input_piece(file_, kind, content));
        }
    }
    void drain() {
        std::vector<std::byte> calls, ticks;
        recorder.drain(calls, ticks);
        put(InputPiece::calls, calls);
        put(InputPiece::ticks, ticks);
    }
    void end() {
        drain();
        ByteSink sink;
        ValueWriter writer(sink);
        const std::uint64_t lost = recorder.lost_ticks();
        pass(writer, lost);
        put(InputPiece::end, sink.bytes());
        std::fflush(file_);
    }

    std::string bytes() const {
        std::ifstream file(path_, std::ios::binary);
        return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
    }
    InputReplay::Report play(const InputReplay::TakeRow& take_row = {}) const {
        return played(path_, take_row);
    }

    // The same of other bytes.
    static InputReplay::Report play_bytes(const std::string& bytes) {
        const std::string path = name();
        std::ofstream(path, std::ios::binary) << bytes;
        const InputReplay::Report report = played(path, {});
        std::filesystem::remove(path);
        return report;
    }

    InputRecorder recorder;

private:
    static std::string name() {
        static int count = 0;
        const auto* const test = ::testing::UnitTest::GetInstance()->current_test_info();
        return ::testing::TempDir() + test->test_suite_name() + test->name() + std::to_string(++count) +
               ".tactus";
    }
    static InputReplay::Report played(const std::string& path, const InputReplay::TakeRow& take_row) {
        std::FILE* const file = std::fopen(path.c_str(), "rb");
        InputReplay::Report report;
        {
            InputReplay replay(file, take_row);
            while (replay.play(1000)) {
            }
            report = replay.report();
        }
        std::fclose(file);
        return report;
    }

    std::string path_;
    std::FILE* file_;
};

// Every tick was played, to the same bits.
inline void expect_whole(const InputReplay::Report& report, std::uint64_t ticks) {
    EXPECT_EQ(report.problem, "");
    EXPECT_EQ(report.ticks, ticks);
    EXPECT_EQ(report.first_different, 0u);
}

}  // namespace tactus::session_test
