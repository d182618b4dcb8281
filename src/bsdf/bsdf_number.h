/* bsdf_number.h - the names of a scattering model's formulas in this precision */
#ifndef ASPI_BSDF_NUMBER_ONCE
#define ASPI_BSDF_NUMBER_ONCE
#define bsdf_value ASP_NDF_NAME(_value)
#define bsdf_value_1 ASP_NDF_NAME(_value_1)
#define bsdf_share_1 ASP_NDF_NAME(_share_1)
#define bsdf_value_n ASP_NDF_NAME(_value_n)
#define bsdf_share ASP_NDF_NAME(_share)
#define bsdf_share_n ASP_NDF_NAME(_share_n)
#define bsdf_eval ASP_NDF_NAME(_eval)
#define bsdf_pdf ASP_NDF_NAME(_pdf)
#define bsdf_eval_n ASP_NDF_NAME(_eval_n)
#define bsdf_pdf_n ASP_NDF_NAME(_pdf_n)
#define bsdf_sample ASP_NDF_NAME(_sample)
#define bsdf_sample_n ASP_NDF_NAME(_sample_n)
#endif
#undef asp_mat
#undef asp_sampled
#if ASP_PRECISION == 64
#define asp_mat asp_material
#define asp_sampled asp_bsdf_sample
#else
#define asp_mat asp_materialf
#define asp_sampled asp_bsdf_samplef
#endif
