#include <windows.h>

#include <aclapi.h>
#include <sddl.h>

#include <array>
#include <string>

#include "support/file_access.hpp"

namespace tactus::testing {

namespace {

// The user of this process, as lists of rights name one; empty where the system does not say.
std::wstring own_name() {
    alignas(TOKEN_USER) std::array<std::byte, sizeof(TOKEN_USER) + SECURITY_MAX_SID_SIZE> user;
    HANDLE token = nullptr;
    if (OpenProcessToken(GetCurrentProcess(), TOKEN_QUERY, &token) == 0) {
        return {};
    }
    DWORD size = 0;
    const bool known = GetTokenInformation(token, TokenUser, user.data(), user.size(), &size) != 0;
    CloseHandle(token);
    wchar_t* text = nullptr;
    if (!known || ConvertSidToStringSidW(reinterpret_cast<TOKEN_USER*>(user.data())->User.Sid, &text) == 0) {
        return {};
    }
    const std::wstring name = text;
    LocalFree(text);
    return name;
}

}  // namespace

// Rights as text: P: none are inherited; A: allow; FA all, FR to read; WD everybody.
bool set_access(const std::filesystem::path& file, bool open_to_others) {
    const std::wstring rights =
        L"D:P(A;;FA;;;" + own_name() + L")" + (open_to_others ? L"(A;;FR;;;WD)" : L"");
    PSECURITY_DESCRIPTOR descriptor = nullptr;
    if (ConvertStringSecurityDescriptorToSecurityDescriptorW(rights.c_str(), SDDL_REVISION_1, &descriptor,
                                                             nullptr) == 0) {
        return false;
    }
    const bool set =
        SetFileSecurityW(file.c_str(), DACL_SECURITY_INFORMATION | PROTECTED_DACL_SECURITY_INFORMATION,
                         descriptor) != 0;
    LocalFree(descriptor);
    return set;
}

}  // namespace tactus::testing
