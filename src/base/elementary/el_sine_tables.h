/* el_sine_tables - constants of sine, cosine and tangent, for the files of this core.
 * Made by tests/elementary/tables.py, which computes every number. */
#ifndef EL_SINE_TABLES_H
#define EL_SINE_TABLES_H

#include <stdint.h>

/* steps in a radian: 256 / (2 pi) */
static const double TURN_STEPS[1] = {
    0x1.45f306dc9c883p+5
};

/* the step 2 pi / 256 as a sum: 30 bits, 30 bits, the rest */
static const double TURN_STEP[3] = {
    0x1.921fb548p-6, -0x1.de973dc8p-37, -0x1.9d9cceba3f91fp-68
};

/* coefficients of (sin r - r) / r^3, ascending powers of r^2 */
static const double SINE_REST[3] = {
    -0x1.5555555555555p-3, 0x1.111111110c1e7p-7, -0x1.a019ac116cf99p-13
};

/* coefficients of (cos r - 1) / r^2, ascending powers of r^2 */
static const double COSINE_REST[3] = {
    -0x1p-1, 0x1.555555554a337p-5, -0x1.6c16612b96411p-10
};

/* row k: sin(2 pi k / 256) as 26 bits and the rest; the nearest double */
static const double SINES[256][3] = {
    { 0.0, 0.0, 0.0 }, { 0x1.92155f8p-6, -0x1.7266081b1d631p-36, 0x1.92155f7a3667ep-6 }, {
    0x1.91f65fp-5, 0x1.0dd813e6ed42fp-33, 0x1.91f65f10dd814p-5 }, { 0x1.2d5209p-4,
    0x1.670cfae65f775p-31, 0x1.2d52092ce19f6p-4 }, { 0x1.917a6cp-4, -0x1.eb25ea0f138c7p-31,
    0x1.917a6bc29b42cp-4 }, { 0x1.f564e58p-4, -0x1.568cf1cbb1f72p-32, 0x1.f564e56a9730ep-4 }, {
    0x1.2c8107p-3, -0x1.719ec5dd9ffebp-31, 0x1.2c8106e8e613ap-3 }, { 0x1.5e21448p-3,
    -0x1.ba601cd59c011p-30, 0x1.5e214448b3fc6p-3 }, { 0x1.8f8b84p-3, -0x1.cb2cfaa4da337p-30,
    0x1.8f8b83c69a60bp-3 }, { 0x1.c0b8268p-3, 0x1.3f27b17e50ebcp-30, 0x1.c0b826a7e4f63p-3 }, {
    0x1.f19f978p-3, 0x1.90af8d57a4222p-30, 0x1.f19f97b215f1bp-3 }, { 0x1.111d26p-2,
    0x1.58fb3bb049841p-29, 0x1.111d262b1f677p-2 }, { 0x1.294063p-2, -0x1.2a60fa574a369p-30,
    0x1.294062ed59f06p-2 }, { 0x1.4135c98p-2, -0x1.f44cff5e6d077p-29, 0x1.4135c94176601p-2 }, {
    0x1.58f9a78p-2, -0x1.2a701180f7eep-29, 0x1.58f9a75ab1fddp-2 }, { 0x1.708853p-2,
    0x1.f48b3d5da731p-31, 0x1.7088530fa459fp-2 }, { 0x1.87de2a8p-2, -0x1.51569d2e59dbap-30,
    0x1.87de2a6aea963p-2 }, { 0x1.9ef794p-2, 0x1.d476c516da813p-29, 0x1.9ef7943a8ed8ap-2 }, {
    0x1.b5d1008p-2, 0x1.e15cc02b66c59p-30, 0x1.b5d1009e15ccp-2 }, { 0x1.cc66e98p-2,
    0x1.31c45e16850e6p-30, 0x1.cc66e9931c45ep-2 }, { 0x1.e2b5d38p-2, 0x1.bd8ec78362475p-36,
    0x1.e2b5d3806f63bp-2 }, { 0x1.f8ba4d8p-2, 0x1.fc4d5cfda27cp-29, 0x1.f8ba4dbf89abap-2 }, {
    0x1.0738798p-1, 0x1.22ffed9697fafp-29, 0x1.073879922ffeep-1 }, { 0x1.11eb358p-1,
    -0x1.f25a6ebde476dp-28, 0x1.11eb3541b4b23p-1 }, { 0x1.1c73b38p-1, 0x1.ae68c86c9774ap-29,
    0x1.1c73b39ae68c8p-1 }, { 0x1.26d055p-1, -0x1.917690abb4e88p-28, 0x1.26d054cdd12dfp-1 }, {
    0x1.30ff8p-1, -0x1.8f47e58f7e631p-28, 0x1.30ff7fce17035p-1 }, { 0x1.3affa28p-1,
    0x1.2050b93c7c4bcp-29, 0x1.3affa292050b9p-1 }, { 0x1.44cf328p-1, -0x1.7b7114f3fc4afp-28,
    0x1.44cf325091dd6p-1 }, { 0x1.4e6cab8p-1, 0x1.f1f2f489e149fp-28, 0x1.4e6cabbe3e5e9p-1 }, {
    0x1.57d6938p-1, -0x1.b989b02eae413p-28, 0x1.57d69348cecap-1 }, { 0x1.610b758p-1,
    -0x1.7169909251b35p-28, 0x1.610b7551d2cdfp-1 }, { 0x1.6a09e68p-1, -0x1.80c4336f74d05p-29,
    0x1.6a09e667f3bcdp-1 }, { 0x1.72d0838p-1, -0x1.00069bcac43c4p-33, 0x1.72d0837efff96p-1 }, {
    0x1.7b5df2p-1, 0x1.3557d76f0ac85p-28, 0x1.7b5df226aafafp-1 }, { 0x1.83b0e08p-1,
    0x1.ffcbb6e90bdfp-28, 0x1.83b0e0bff976ep-1 }, { 0x1.8bc8068p-1, 0x1.8a8ba05a743dap-28,
    0x1.8bc806b151741p-1 }, { 0x1.93a2248p-1, 0x1.9263fb4f5066ap-29, 0x1.93a22499263fbp-1 }, {
    0x1.9b3e048p-1, -0x1.8f17e98771434p-34, 0x1.9b3e047f38741p-1 }, { 0x1.a29a7ap-1,
    0x1.189e0776ba27fp-31, 0x1.a29a7a0462782p-1 }, { 0x1.a9b6628p-1, 0x1.0ea1a3033ec62p-29,
    0x1.a9b66290ea1a3p-1 }, { 0x1.b090a58p-1, 0x1.501ff9b64974p-33, 0x1.b090a581502p-1 }, {
    0x1.b728348p-1, -0x1.7348e1378d3e6p-28, 0x1.b728345196e3ep-1 }, { 0x1.bd7c0bp-1,
    -0x1.c8356b304b4e6p-28, 0x1.bd7c0ac6f952ap-1 }, { 0x1.c38b2fp-1, 0x1.80bdb0d23e9d1p-29,
    0x1.c38b2f180bdb1p-1 }, { 0x1.c954b2p-1, 0x1.3411f4f68244fp-29, 0x1.c954b213411f5p-1 }, {
    0x1.ced7af8p-1, -0x1.e19c46879edafp-28, 0x1.ced7af43cc773p-1 }, { 0x1.d4134dp-1,
    0x1.4dc939ac42b5bp-29, 0x1.d4134d14dc93ap-1 }, { 0x1.d906bdp-1, -0x1.9ae573aea067cp-30,
    0x1.d906bcf328d46p-1 }, { 0x1.ddb13b8p-1, -0x1.333dc39f0f20ep-29, 0x1.ddb13b6ccc23cp-1 }, {
    0x1.e212108p-1, -0x1.84bc8da0298eep-28, 0x1.e212104f686e5p-1 }, { 0x1.e6288fp-1,
    -0x1.db8f7708b5ab8p-28, 0x1.e6288ec48e112p-1 }, { 0x1.e9f4158p-1, -0x1.39d225a27d387p-29,
    0x1.e9f4156c62ddap-1 }, { 0x1.ed740e8p-1, -0x1.2f6d3985f4e1cp-30, 0x1.ed740e7684963p-1 }, {
    0x1.f0a7ef8p-1, 0x1.c9186b952c7aep-28, 0x1.f0a7efb9230d7p-1 }, { 0x1.f38f3bp-1,
    -0x1.cd8d3b9d7bafbp-28, 0x1.f38f3ac64e589p-1 }, { 0x1.f6297dp-1, -0x1.1469faa77a357p-34,
    0x1.f6297cff75cbp-1 }, { 0x1.f8764f8p-1, 0x1.38a5d49ab2567p-28, 0x1.f8764fa714ba9p-1 }, {
    0x1.fa7558p-1, -0x1.eeb5d2bd05465p-30, 0x1.fa7557f08a517p-1 }, { 0x1.fc2647p-1,
    0x1.c33fa68f64334p-30, 0x1.fc26470e19fd3p-1 }, { 0x1.fd88dap-1, 0x1.e89292cf04139p-28,
    0x1.fd88da3d12526p-1 }, { 0x1.fe9cdbp-1, -0x1.7f3be2f56f099p-28, 0x1.fe9cdad01883ap-1 }, {
    0x1.ff621ep-1, 0x1.bcb6bef1d421fp-28, 0x1.ff621e3796d7ep-1 }, { 0x1.ffd886p-1,
    0x1.099a19765595dp-30, 0x1.ffd886084cd0dp-1 }, { 0x1p+0, 0.0, 0x1p+0 }, { 0x1.ffd886p-1,
    0x1.099a19765595dp-30, 0x1.ffd886084cd0dp-1 }, { 0x1.ff621ep-1, 0x1.bcb6bef1d421fp-28,
    0x1.ff621e3796d7ep-1 }, { 0x1.fe9cdbp-1, -0x1.7f3be2f56f099p-28, 0x1.fe9cdad01883ap-1 }, {
    0x1.fd88dap-1, 0x1.e89292cf04139p-28, 0x1.fd88da3d12526p-1 }, { 0x1.fc2647p-1,
    0x1.c33fa68f64334p-30, 0x1.fc26470e19fd3p-1 }, { 0x1.fa7558p-1, -0x1.eeb5d2bd05465p-30,
    0x1.fa7557f08a517p-1 }, { 0x1.f8764f8p-1, 0x1.38a5d49ab2567p-28, 0x1.f8764fa714ba9p-1 }, {
    0x1.f6297dp-1, -0x1.1469faa77a357p-34, 0x1.f6297cff75cbp-1 }, { 0x1.f38f3bp-1,
    -0x1.cd8d3b9d7bafbp-28, 0x1.f38f3ac64e589p-1 }, { 0x1.f0a7ef8p-1, 0x1.c9186b952c7aep-28,
    0x1.f0a7efb9230d7p-1 }, { 0x1.ed740e8p-1, -0x1.2f6d3985f4e1cp-30, 0x1.ed740e7684963p-1 }, {
    0x1.e9f4158p-1, -0x1.39d225a27d387p-29, 0x1.e9f4156c62ddap-1 }, { 0x1.e6288fp-1,
    -0x1.db8f7708b5ab8p-28, 0x1.e6288ec48e112p-1 }, { 0x1.e212108p-1, -0x1.84bc8da0298eep-28,
    0x1.e212104f686e5p-1 }, { 0x1.ddb13b8p-1, -0x1.333dc39f0f20ep-29, 0x1.ddb13b6ccc23cp-1 }, {
    0x1.d906bdp-1, -0x1.9ae573aea067cp-30, 0x1.d906bcf328d46p-1 }, { 0x1.d4134dp-1,
    0x1.4dc939ac42b5bp-29, 0x1.d4134d14dc93ap-1 }, { 0x1.ced7af8p-1, -0x1.e19c46879edafp-28,
    0x1.ced7af43cc773p-1 }, { 0x1.c954b2p-1, 0x1.3411f4f68244fp-29, 0x1.c954b213411f5p-1 }, {
    0x1.c38b2fp-1, 0x1.80bdb0d23e9d1p-29, 0x1.c38b2f180bdb1p-1 }, { 0x1.bd7c0bp-1,
    -0x1.c8356b304b4e6p-28, 0x1.bd7c0ac6f952ap-1 }, { 0x1.b728348p-1, -0x1.7348e1378d3e6p-28,
    0x1.b728345196e3ep-1 }, { 0x1.b090a58p-1, 0x1.501ff9b64974p-33, 0x1.b090a581502p-1 }, {
    0x1.a9b6628p-1, 0x1.0ea1a3033ec62p-29, 0x1.a9b66290ea1a3p-1 }, { 0x1.a29a7ap-1,
    0x1.189e0776ba27fp-31, 0x1.a29a7a0462782p-1 }, { 0x1.9b3e048p-1, -0x1.8f17e98771434p-34,
    0x1.9b3e047f38741p-1 }, { 0x1.93a2248p-1, 0x1.9263fb4f5066ap-29, 0x1.93a22499263fbp-1 }, {
    0x1.8bc8068p-1, 0x1.8a8ba05a743dap-28, 0x1.8bc806b151741p-1 }, { 0x1.83b0e08p-1,
    0x1.ffcbb6e90bdfp-28, 0x1.83b0e0bff976ep-1 }, { 0x1.7b5df2p-1, 0x1.3557d76f0ac85p-28,
    0x1.7b5df226aafafp-1 }, { 0x1.72d0838p-1, -0x1.00069bcac43c4p-33, 0x1.72d0837efff96p-1 }, {
    0x1.6a09e68p-1, -0x1.80c4336f74d05p-29, 0x1.6a09e667f3bcdp-1 }, { 0x1.610b758p-1,
    -0x1.7169909251b35p-28, 0x1.610b7551d2cdfp-1 }, { 0x1.57d6938p-1, -0x1.b989b02eae413p-28,
    0x1.57d69348cecap-1 }, { 0x1.4e6cab8p-1, 0x1.f1f2f489e149fp-28, 0x1.4e6cabbe3e5e9p-1 }, {
    0x1.44cf328p-1, -0x1.7b7114f3fc4afp-28, 0x1.44cf325091dd6p-1 }, { 0x1.3affa28p-1,
    0x1.2050b93c7c4bcp-29, 0x1.3affa292050b9p-1 }, { 0x1.30ff8p-1, -0x1.8f47e58f7e631p-28,
    0x1.30ff7fce17035p-1 }, { 0x1.26d055p-1, -0x1.917690abb4e88p-28, 0x1.26d054cdd12dfp-1 }, {
    0x1.1c73b38p-1, 0x1.ae68c86c9774ap-29, 0x1.1c73b39ae68c8p-1 }, { 0x1.11eb358p-1,
    -0x1.f25a6ebde476dp-28, 0x1.11eb3541b4b23p-1 }, { 0x1.0738798p-1, 0x1.22ffed9697fafp-29,
    0x1.073879922ffeep-1 }, { 0x1.f8ba4d8p-2, 0x1.fc4d5cfda27cp-29, 0x1.f8ba4dbf89abap-2 }, {
    0x1.e2b5d38p-2, 0x1.bd8ec78362475p-36, 0x1.e2b5d3806f63bp-2 }, { 0x1.cc66e98p-2,
    0x1.31c45e16850e6p-30, 0x1.cc66e9931c45ep-2 }, { 0x1.b5d1008p-2, 0x1.e15cc02b66c59p-30,
    0x1.b5d1009e15ccp-2 }, { 0x1.9ef794p-2, 0x1.d476c516da813p-29, 0x1.9ef7943a8ed8ap-2 }, {
    0x1.87de2a8p-2, -0x1.51569d2e59dbap-30, 0x1.87de2a6aea963p-2 }, { 0x1.708853p-2,
    0x1.f48b3d5da731p-31, 0x1.7088530fa459fp-2 }, { 0x1.58f9a78p-2, -0x1.2a701180f7eep-29,
    0x1.58f9a75ab1fddp-2 }, { 0x1.4135c98p-2, -0x1.f44cff5e6d077p-29, 0x1.4135c94176601p-2 }, {
    0x1.294063p-2, -0x1.2a60fa574a369p-30, 0x1.294062ed59f06p-2 }, { 0x1.111d26p-2,
    0x1.58fb3bb049841p-29, 0x1.111d262b1f677p-2 }, { 0x1.f19f978p-3, 0x1.90af8d57a4222p-30,
    0x1.f19f97b215f1bp-3 }, { 0x1.c0b8268p-3, 0x1.3f27b17e50ebcp-30, 0x1.c0b826a7e4f63p-3 }, {
    0x1.8f8b84p-3, -0x1.cb2cfaa4da337p-30, 0x1.8f8b83c69a60bp-3 }, { 0x1.5e21448p-3,
    -0x1.ba601cd59c011p-30, 0x1.5e214448b3fc6p-3 }, { 0x1.2c8107p-3, -0x1.719ec5dd9ffebp-31,
    0x1.2c8106e8e613ap-3 }, { 0x1.f564e58p-4, -0x1.568cf1cbb1f72p-32, 0x1.f564e56a9730ep-4 }, {
    0x1.917a6cp-4, -0x1.eb25ea0f138c7p-31, 0x1.917a6bc29b42cp-4 }, { 0x1.2d5209p-4,
    0x1.670cfae65f775p-31, 0x1.2d52092ce19f6p-4 }, { 0x1.91f65fp-5, 0x1.0dd813e6ed42fp-33,
    0x1.91f65f10dd814p-5 }, { 0x1.92155f8p-6, -0x1.7266081b1d631p-36, 0x1.92155f7a3667ep-6 }, {
    0.0, 0.0, 0.0 }, { -0x1.92155f8p-6, 0x1.7266081b1d631p-36, -0x1.92155f7a3667ep-6 }, {
    -0x1.91f65fp-5, -0x1.0dd813e6ed42fp-33, -0x1.91f65f10dd814p-5 }, { -0x1.2d5209p-4,
    -0x1.670cfae65f775p-31, -0x1.2d52092ce19f6p-4 }, { -0x1.917a6cp-4, 0x1.eb25ea0f138c7p-31,
    -0x1.917a6bc29b42cp-4 }, { -0x1.f564e58p-4, 0x1.568cf1cbb1f72p-32, -0x1.f564e56a9730ep-4 },
    { -0x1.2c8107p-3, 0x1.719ec5dd9ffebp-31, -0x1.2c8106e8e613ap-3 }, { -0x1.5e21448p-3,
    0x1.ba601cd59c011p-30, -0x1.5e214448b3fc6p-3 }, { -0x1.8f8b84p-3, 0x1.cb2cfaa4da337p-30,
    -0x1.8f8b83c69a60bp-3 }, { -0x1.c0b8268p-3, -0x1.3f27b17e50ebcp-30, -0x1.c0b826a7e4f63p-3 },
    { -0x1.f19f978p-3, -0x1.90af8d57a4222p-30, -0x1.f19f97b215f1bp-3 }, { -0x1.111d26p-2,
    -0x1.58fb3bb049841p-29, -0x1.111d262b1f677p-2 }, { -0x1.294063p-2, 0x1.2a60fa574a369p-30,
    -0x1.294062ed59f06p-2 }, { -0x1.4135c98p-2, 0x1.f44cff5e6d077p-29, -0x1.4135c94176601p-2 },
    { -0x1.58f9a78p-2, 0x1.2a701180f7eep-29, -0x1.58f9a75ab1fddp-2 }, { -0x1.708853p-2,
    -0x1.f48b3d5da731p-31, -0x1.7088530fa459fp-2 }, { -0x1.87de2a8p-2, 0x1.51569d2e59dbap-30,
    -0x1.87de2a6aea963p-2 }, { -0x1.9ef794p-2, -0x1.d476c516da813p-29, -0x1.9ef7943a8ed8ap-2 },
    { -0x1.b5d1008p-2, -0x1.e15cc02b66c59p-30, -0x1.b5d1009e15ccp-2 }, { -0x1.cc66e98p-2,
    -0x1.31c45e16850e6p-30, -0x1.cc66e9931c45ep-2 }, { -0x1.e2b5d38p-2, -0x1.bd8ec78362475p-36,
    -0x1.e2b5d3806f63bp-2 }, { -0x1.f8ba4d8p-2, -0x1.fc4d5cfda27cp-29, -0x1.f8ba4dbf89abap-2 },
    { -0x1.0738798p-1, -0x1.22ffed9697fafp-29, -0x1.073879922ffeep-1 }, { -0x1.11eb358p-1,
    0x1.f25a6ebde476dp-28, -0x1.11eb3541b4b23p-1 }, { -0x1.1c73b38p-1, -0x1.ae68c86c9774ap-29,
    -0x1.1c73b39ae68c8p-1 }, { -0x1.26d055p-1, 0x1.917690abb4e88p-28, -0x1.26d054cdd12dfp-1 }, {
    -0x1.30ff8p-1, 0x1.8f47e58f7e631p-28, -0x1.30ff7fce17035p-1 }, { -0x1.3affa28p-1,
    -0x1.2050b93c7c4bcp-29, -0x1.3affa292050b9p-1 }, { -0x1.44cf328p-1, 0x1.7b7114f3fc4afp-28,
    -0x1.44cf325091dd6p-1 }, { -0x1.4e6cab8p-1, -0x1.f1f2f489e149fp-28, -0x1.4e6cabbe3e5e9p-1 },
    { -0x1.57d6938p-1, 0x1.b989b02eae413p-28, -0x1.57d69348cecap-1 }, { -0x1.610b758p-1,
    0x1.7169909251b35p-28, -0x1.610b7551d2cdfp-1 }, { -0x1.6a09e68p-1, 0x1.80c4336f74d05p-29,
    -0x1.6a09e667f3bcdp-1 }, { -0x1.72d0838p-1, 0x1.00069bcac43c4p-33, -0x1.72d0837efff96p-1 },
    { -0x1.7b5df2p-1, -0x1.3557d76f0ac85p-28, -0x1.7b5df226aafafp-1 }, { -0x1.83b0e08p-1,
    -0x1.ffcbb6e90bdfp-28, -0x1.83b0e0bff976ep-1 }, { -0x1.8bc8068p-1, -0x1.8a8ba05a743dap-28,
    -0x1.8bc806b151741p-1 }, { -0x1.93a2248p-1, -0x1.9263fb4f5066ap-29, -0x1.93a22499263fbp-1 },
    { -0x1.9b3e048p-1, 0x1.8f17e98771434p-34, -0x1.9b3e047f38741p-1 }, { -0x1.a29a7ap-1,
    -0x1.189e0776ba27fp-31, -0x1.a29a7a0462782p-1 }, { -0x1.a9b6628p-1, -0x1.0ea1a3033ec62p-29,
    -0x1.a9b66290ea1a3p-1 }, { -0x1.b090a58p-1, -0x1.501ff9b64974p-33, -0x1.b090a581502p-1 }, {
    -0x1.b728348p-1, 0x1.7348e1378d3e6p-28, -0x1.b728345196e3ep-1 }, { -0x1.bd7c0bp-1,
    0x1.c8356b304b4e6p-28, -0x1.bd7c0ac6f952ap-1 }, { -0x1.c38b2fp-1, -0x1.80bdb0d23e9d1p-29,
    -0x1.c38b2f180bdb1p-1 }, { -0x1.c954b2p-1, -0x1.3411f4f68244fp-29, -0x1.c954b213411f5p-1 },
    { -0x1.ced7af8p-1, 0x1.e19c46879edafp-28, -0x1.ced7af43cc773p-1 }, { -0x1.d4134dp-1,
    -0x1.4dc939ac42b5bp-29, -0x1.d4134d14dc93ap-1 }, { -0x1.d906bdp-1, 0x1.9ae573aea067cp-30,
    -0x1.d906bcf328d46p-1 }, { -0x1.ddb13b8p-1, 0x1.333dc39f0f20ep-29, -0x1.ddb13b6ccc23cp-1 },
    { -0x1.e212108p-1, 0x1.84bc8da0298eep-28, -0x1.e212104f686e5p-1 }, { -0x1.e6288fp-1,
    0x1.db8f7708b5ab8p-28, -0x1.e6288ec48e112p-1 }, { -0x1.e9f4158p-1, 0x1.39d225a27d387p-29,
    -0x1.e9f4156c62ddap-1 }, { -0x1.ed740e8p-1, 0x1.2f6d3985f4e1cp-30, -0x1.ed740e7684963p-1 },
    { -0x1.f0a7ef8p-1, -0x1.c9186b952c7aep-28, -0x1.f0a7efb9230d7p-1 }, { -0x1.f38f3bp-1,
    0x1.cd8d3b9d7bafbp-28, -0x1.f38f3ac64e589p-1 }, { -0x1.f6297dp-1, 0x1.1469faa77a357p-34,
    -0x1.f6297cff75cbp-1 }, { -0x1.f8764f8p-1, -0x1.38a5d49ab2567p-28, -0x1.f8764fa714ba9p-1 },
    { -0x1.fa7558p-1, 0x1.eeb5d2bd05465p-30, -0x1.fa7557f08a517p-1 }, { -0x1.fc2647p-1,
    -0x1.c33fa68f64334p-30, -0x1.fc26470e19fd3p-1 }, { -0x1.fd88dap-1, -0x1.e89292cf04139p-28,
    -0x1.fd88da3d12526p-1 }, { -0x1.fe9cdbp-1, 0x1.7f3be2f56f099p-28, -0x1.fe9cdad01883ap-1 }, {
    -0x1.ff621ep-1, -0x1.bcb6bef1d421fp-28, -0x1.ff621e3796d7ep-1 }, { -0x1.ffd886p-1,
    -0x1.099a19765595dp-30, -0x1.ffd886084cd0dp-1 }, { -0x1p+0, 0.0, -0x1p+0 }, {
    -0x1.ffd886p-1, -0x1.099a19765595dp-30, -0x1.ffd886084cd0dp-1 }, { -0x1.ff621ep-1,
    -0x1.bcb6bef1d421fp-28, -0x1.ff621e3796d7ep-1 }, { -0x1.fe9cdbp-1, 0x1.7f3be2f56f099p-28,
    -0x1.fe9cdad01883ap-1 }, { -0x1.fd88dap-1, -0x1.e89292cf04139p-28, -0x1.fd88da3d12526p-1 },
    { -0x1.fc2647p-1, -0x1.c33fa68f64334p-30, -0x1.fc26470e19fd3p-1 }, { -0x1.fa7558p-1,
    0x1.eeb5d2bd05465p-30, -0x1.fa7557f08a517p-1 }, { -0x1.f8764f8p-1, -0x1.38a5d49ab2567p-28,
    -0x1.f8764fa714ba9p-1 }, { -0x1.f6297dp-1, 0x1.1469faa77a357p-34, -0x1.f6297cff75cbp-1 }, {
    -0x1.f38f3bp-1, 0x1.cd8d3b9d7bafbp-28, -0x1.f38f3ac64e589p-1 }, { -0x1.f0a7ef8p-1,
    -0x1.c9186b952c7aep-28, -0x1.f0a7efb9230d7p-1 }, { -0x1.ed740e8p-1, 0x1.2f6d3985f4e1cp-30,
    -0x1.ed740e7684963p-1 }, { -0x1.e9f4158p-1, 0x1.39d225a27d387p-29, -0x1.e9f4156c62ddap-1 },
    { -0x1.e6288fp-1, 0x1.db8f7708b5ab8p-28, -0x1.e6288ec48e112p-1 }, { -0x1.e212108p-1,
    0x1.84bc8da0298eep-28, -0x1.e212104f686e5p-1 }, { -0x1.ddb13b8p-1, 0x1.333dc39f0f20ep-29,
    -0x1.ddb13b6ccc23cp-1 }, { -0x1.d906bdp-1, 0x1.9ae573aea067cp-30, -0x1.d906bcf328d46p-1 }, {
    -0x1.d4134dp-1, -0x1.4dc939ac42b5bp-29, -0x1.d4134d14dc93ap-1 }, { -0x1.ced7af8p-1,
    0x1.e19c46879edafp-28, -0x1.ced7af43cc773p-1 }, { -0x1.c954b2p-1, -0x1.3411f4f68244fp-29,
    -0x1.c954b213411f5p-1 }, { -0x1.c38b2fp-1, -0x1.80bdb0d23e9d1p-29, -0x1.c38b2f180bdb1p-1 },
    { -0x1.bd7c0bp-1, 0x1.c8356b304b4e6p-28, -0x1.bd7c0ac6f952ap-1 }, { -0x1.b728348p-1,
    0x1.7348e1378d3e6p-28, -0x1.b728345196e3ep-1 }, { -0x1.b090a58p-1, -0x1.501ff9b64974p-33,
    -0x1.b090a581502p-1 }, { -0x1.a9b6628p-1, -0x1.0ea1a3033ec62p-29, -0x1.a9b66290ea1a3p-1 }, {
    -0x1.a29a7ap-1, -0x1.189e0776ba27fp-31, -0x1.a29a7a0462782p-1 }, { -0x1.9b3e048p-1,
    0x1.8f17e98771434p-34, -0x1.9b3e047f38741p-1 }, { -0x1.93a2248p-1, -0x1.9263fb4f5066ap-29,
    -0x1.93a22499263fbp-1 }, { -0x1.8bc8068p-1, -0x1.8a8ba05a743dap-28, -0x1.8bc806b151741p-1 },
    { -0x1.83b0e08p-1, -0x1.ffcbb6e90bdfp-28, -0x1.83b0e0bff976ep-1 }, { -0x1.7b5df2p-1,
    -0x1.3557d76f0ac85p-28, -0x1.7b5df226aafafp-1 }, { -0x1.72d0838p-1, 0x1.00069bcac43c4p-33,
    -0x1.72d0837efff96p-1 }, { -0x1.6a09e68p-1, 0x1.80c4336f74d05p-29, -0x1.6a09e667f3bcdp-1 },
    { -0x1.610b758p-1, 0x1.7169909251b35p-28, -0x1.610b7551d2cdfp-1 }, { -0x1.57d6938p-1,
    0x1.b989b02eae413p-28, -0x1.57d69348cecap-1 }, { -0x1.4e6cab8p-1, -0x1.f1f2f489e149fp-28,
    -0x1.4e6cabbe3e5e9p-1 }, { -0x1.44cf328p-1, 0x1.7b7114f3fc4afp-28, -0x1.44cf325091dd6p-1 },
    { -0x1.3affa28p-1, -0x1.2050b93c7c4bcp-29, -0x1.3affa292050b9p-1 }, { -0x1.30ff8p-1,
    0x1.8f47e58f7e631p-28, -0x1.30ff7fce17035p-1 }, { -0x1.26d055p-1, 0x1.917690abb4e88p-28,
    -0x1.26d054cdd12dfp-1 }, { -0x1.1c73b38p-1, -0x1.ae68c86c9774ap-29, -0x1.1c73b39ae68c8p-1 },
    { -0x1.11eb358p-1, 0x1.f25a6ebde476dp-28, -0x1.11eb3541b4b23p-1 }, { -0x1.0738798p-1,
    -0x1.22ffed9697fafp-29, -0x1.073879922ffeep-1 }, { -0x1.f8ba4d8p-2, -0x1.fc4d5cfda27cp-29,
    -0x1.f8ba4dbf89abap-2 }, { -0x1.e2b5d38p-2, -0x1.bd8ec78362475p-36, -0x1.e2b5d3806f63bp-2 },
    { -0x1.cc66e98p-2, -0x1.31c45e16850e6p-30, -0x1.cc66e9931c45ep-2 }, { -0x1.b5d1008p-2,
    -0x1.e15cc02b66c59p-30, -0x1.b5d1009e15ccp-2 }, { -0x1.9ef794p-2, -0x1.d476c516da813p-29,
    -0x1.9ef7943a8ed8ap-2 }, { -0x1.87de2a8p-2, 0x1.51569d2e59dbap-30, -0x1.87de2a6aea963p-2 },
    { -0x1.708853p-2, -0x1.f48b3d5da731p-31, -0x1.7088530fa459fp-2 }, { -0x1.58f9a78p-2,
    0x1.2a701180f7eep-29, -0x1.58f9a75ab1fddp-2 }, { -0x1.4135c98p-2, 0x1.f44cff5e6d077p-29,
    -0x1.4135c94176601p-2 }, { -0x1.294063p-2, 0x1.2a60fa574a369p-30, -0x1.294062ed59f06p-2 }, {
    -0x1.111d26p-2, -0x1.58fb3bb049841p-29, -0x1.111d262b1f677p-2 }, { -0x1.f19f978p-3,
    -0x1.90af8d57a4222p-30, -0x1.f19f97b215f1bp-3 }, { -0x1.c0b8268p-3, -0x1.3f27b17e50ebcp-30,
    -0x1.c0b826a7e4f63p-3 }, { -0x1.8f8b84p-3, 0x1.cb2cfaa4da337p-30, -0x1.8f8b83c69a60bp-3 }, {
    -0x1.5e21448p-3, 0x1.ba601cd59c011p-30, -0x1.5e214448b3fc6p-3 }, { -0x1.2c8107p-3,
    0x1.719ec5dd9ffebp-31, -0x1.2c8106e8e613ap-3 }, { -0x1.f564e58p-4, 0x1.568cf1cbb1f72p-32,
    -0x1.f564e56a9730ep-4 }, { -0x1.917a6cp-4, 0x1.eb25ea0f138c7p-31, -0x1.917a6bc29b42cp-4 }, {
    -0x1.2d5209p-4, -0x1.670cfae65f775p-31, -0x1.2d52092ce19f6p-4 }, { -0x1.91f65fp-5,
    -0x1.0dd813e6ed42fp-33, -0x1.91f65f10dd814p-5 }, { -0x1.92155f8p-6, 0x1.7266081b1d631p-36,
    -0x1.92155f7a3667ep-6 }
};

/* pi / 2 as a sum of two doubles */
static const double QUARTER[2] = {
    0x1.921fb54442d18p+0, 0x1.1a62633145c07p-54
};

/* fractional bits of 2 / pi, in words of 32 bits, the first one first */
static const uint32_t WORDS[40] = {
    0xa2f9836e, 0x4e441529, 0xfc2757d1, 0xf534ddc0, 0xdb629599, 0x3c439041, 0xfe5163ab,
    0xdebbc561, 0xb7246e3a, 0x424dd2e0, 0x06492eea, 0x09d1921c, 0xfe1deb1c, 0xb129a73e,
    0xe88235f5, 0x2ebb4484, 0xe99c7026, 0xb45f7e41, 0x3991d639, 0x835339f4, 0x9c845f8b,
    0xbdf9283b, 0x1ff897ff, 0xde05980f, 0xef2f118b, 0x5a0a6d1f, 0x6d367ecf, 0x27cb09b7,
    0x4f463f66, 0x9e5fea2d, 0x7527bac7, 0xebe5f17b, 0x3d0739f7, 0x8a5292ea, 0x6bfb5fb1,
    0x1f8d5d08, 0x56033046, 0xfc7b6bab, 0xf0cfbc20, 0x9af4361d
};

#endif
