// The client's end against a service that sends more than it is asked for.
#include "devices/haply/web_socket.hpp"

#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <string>
#include <thread>

namespace tactus::web_socket_linux_test {
namespace {

TEST(WebSocket, AFloodIsReadALittleAtATimeAndWhole) {
    if (RuntimeLibrary wslay; !wslay.load({"libwslay.so.1"}, "wslay_event_recv")) {
        GTEST_SKIP() << "libwslay1 is needed";
    }
    const int listener = socket(AF_INET, SOCK_STREAM, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    ASSERT_EQ(bind(listener, reinterpret_cast<sockaddr*>(&address), size), 0);
    ASSERT_EQ(listen(listener, 1), 0);
    ASSERT_EQ(getsockname(listener, reinterpret_cast<sockaddr*>(&address), &size), 0);

    constexpr int texts = 300;
    constexpr std::size_t text_size = 1000;
    std::thread service([listener] {
        const int client = accept(listener, nullptr, nullptr);
        char request[1024];
        static_cast<void>(recv(client, request, sizeof request, 0));
        const std::string answer = "HTTP/1.1 101 Switching Protocols\r\n\r\n";
        send(client, answer.data(), answer.size(), MSG_NOSIGNAL);
        const std::string head{'\x81', '\x7e', char(text_size >> 8), char(text_size & 0xff)};
        std::string flood;
        for (int i = 0; i < texts; ++i) {
            flood += head + std::string(text_size, 'a');
        }
        for (std::size_t sent = 0; sent < flood.size();) {
            const ssize_t more = send(client, flood.data() + sent, flood.size() - sent, MSG_NOSIGNAL);
            if (more <= 0) {
                break;
            }
            sent += static_cast<std::size_t>(more);
        }
        char end;
        static_cast<void>(recv(client, &end, 1, 0));
        close(client);
    });

    const std::atomic<bool> stop{false};
    WebSocket socket;
    ASSERT_EQ(socket.open(ntohs(address.sin_port), stop), "");
    std::string text;
    int came = 0, most_at_once = 0;
    while (came < texts && !socket.is_gone()) {
        // So much waits by then that one call would take all of it.
        std::this_thread::sleep_for(std::chrono::milliseconds(came == 0 ? 50 : 0));
        const int now = socket.receive(text, 10'000'000);
        most_at_once = std::max(most_at_once, now);
        came += now;
    }
    EXPECT_EQ(came, texts);
    EXPECT_EQ(text, std::string(text_size, 'a'));
    EXPECT_LE(most_at_once, 66);
    EXPECT_GT(most_at_once, 60) << "that much waited";
    socket.close();
    service.join();
    close(listener);
}

}  // namespace
}  // namespace tactus::web_socket_linux_test
