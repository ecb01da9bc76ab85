String(const char* p_utf8);
String(const char32_t* p_text);
static String utf8(const char* p_text, int64_t p_length = -1);
CharString utf8() const;
CharString ascii() const;
Char32String utf32() const;

const char32_t& operator[](int64_t p_index) const;
char32_t& operator[](int64_t p_index);

String& operator+=(const String& p_other);
String& operator+=(const char* p_other);
String& operator+=(char32_t p_other);
String operator+(const char* p_other) const;
String operator+(char32_t p_other) const;
bool operator==(const char* p_other) const;
bool operator!=(const char* p_other) const;
