#include "platform/private_file.hpp"

#include <windows.h>

#include <aclapi.h>

#include <array>

#include "platform/system_message.hpp"
#include "platform/wide_text_windows.hpp"

namespace tactus {

namespace {

PrivateFile refused(FileTrouble trouble, std::string system_text = {}, std::string way_out = {}) {
    return {trouble, {}, std::move(system_text), std::move(way_out)};
}

// Closes itself.
struct File {
    explicit File(const std::string& path)
        : handle(CreateFileW(windows::to_wide(path).c_str(), GENERIC_READ, FILE_SHARE_READ, nullptr,
                             OPEN_EXISTING, FILE_FLAG_BACKUP_SEMANTICS, nullptr)) {}
    ~File() {
        if (handle != INVALID_HANDLE_VALUE) {
            CloseHandle(handle);
        }
    }
    File(const File&) = delete;
    File& operator=(const File&) = delete;
    HANDLE handle;
};

bool is_ordinary(HANDLE file) {
    BY_HANDLE_FILE_INFORMATION about{};
    return GetFileType(file) == FILE_TYPE_DISK && GetFileInformationByHandle(file, &about) != 0 &&
           (about.dwFileAttributes & FILE_ATTRIBUTE_DIRECTORY) == 0;
}

// The user that this process runs as.
struct OwnIdentity {
    OwnIdentity() {
        HANDLE token = nullptr;
        if (OpenProcessToken(GetCurrentProcess(), TOKEN_QUERY, &token) != 0) {
            DWORD size = 0;
            known = GetTokenInformation(token, TokenUser, bytes.data(), bytes.size(), &size) != 0;
            CloseHandle(token);
        }
    }
    PSID get() { return reinterpret_cast<TOKEN_USER*>(bytes.data())->User.Sid; }

    alignas(TOKEN_USER) std::array<std::byte, sizeof(TOKEN_USER) + SECURITY_MAX_SID_SIZE> bytes;
    bool known = false;
};

// Who may read everything anyway.
bool is_the_system(PSID who) {
    return IsWellKnownSid(who, WinLocalSystemSid) != 0 ||
           IsWellKnownSid(who, WinBuiltinAdministratorsSid) != 0;
}

// A file without a list of rights is open to everybody.
bool is_private(const ACL* rights, PSID owner, PSID user) {
    if (rights == nullptr) {
        return false;
    }
    constexpr ACCESS_MASK reads_or_writes =
        FILE_READ_DATA | FILE_WRITE_DATA | FILE_APPEND_DATA | GENERIC_READ | GENERIC_WRITE | GENERIC_ALL;
    for (DWORD i = 0; i < rights->AceCount; ++i) {
        void* found = nullptr;
        if (GetAce(const_cast<ACL*>(rights), i, &found) == 0) {
            return false;
        }
        auto* const entry = static_cast<ACCESS_ALLOWED_ACE*>(found);
        if (entry->Header.AceType != ACCESS_ALLOWED_ACE_TYPE || (entry->Mask & reads_or_writes) == 0) {
            continue;
        }
        const PSID who = &entry->SidStart;
        if (EqualSid(who, user) == 0 && EqualSid(who, owner) == 0 && !is_the_system(who)) {
            return false;
        }
    }
    return true;
}

bool is_private(HANDLE file) {
    OwnIdentity user;
    PSID owner = nullptr;
    PACL rights = nullptr;
    PSECURITY_DESCRIPTOR all = nullptr;
    if (!user.known ||
        GetSecurityInfo(file, SE_FILE_OBJECT, OWNER_SECURITY_INFORMATION | DACL_SECURITY_INFORMATION, &owner,
                        nullptr, &rights, nullptr, &all) != ERROR_SUCCESS) {
        return false;
    }
    const bool found = is_private(rights, owner, user.get());
    LocalFree(all);
    return found;
}

}  // namespace

PrivateFile read_private_file(const std::string& path, std::size_t max_bytes) {
    const File file(path);
    if (file.handle == INVALID_HANDLE_VALUE) {
        return refused(FileTrouble::unreadable, last_system_message());
    }
    if (!is_ordinary(file.handle)) {
        return refused(FileTrouble::not_ordinary);
    }
    if (!is_private(file.handle)) {
        return refused(FileTrouble::open_to_others, {},
                       "icacls \"" + path + "\" /inheritance:r /grant:r \"%USERNAME%:F\"");
    }
    std::string bytes(max_bytes + 1, '\0');
    DWORD size = 0;
    if (ReadFile(file.handle, bytes.data(), static_cast<DWORD>(bytes.size()), &size, nullptr) == 0) {
        return refused(FileTrouble::unreadable, last_system_message());
    }
    if (size > max_bytes) {
        return refused(FileTrouble::too_long);
    }
    bytes.resize(size);
    return {FileTrouble::none, bytes, {}, {}};
}

}  // namespace tactus
