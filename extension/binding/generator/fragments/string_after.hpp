
String operator+(const char* p_left, const String& p_right);
bool operator==(const char* p_left, const String& p_right);
bool operator!=(const char* p_left, const String& p_right);

// Numbers as text.
String itos(int64_t p_value);
String rtos(double p_value);
String rtoss(double p_value);
